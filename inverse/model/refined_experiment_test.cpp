#include "model/refined_experiment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "mesh/generators.h"
#include "mesh/surface.h"
#include "mesh/tet_nodes.h"
#include "model/load_case.h"

namespace aspic {
namespace {

constexpr double kColumnYoung = 1e4;

std::vector<int> at_bottom(const TetMesh& mesh) {
  std::vector<int> result;
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (mesh.rest[v][2] < 1e-9) result.push_back(v);
  return result;
}

// A column that stands on z = 0 and sags; markers on its top and sides.
Experiment column(int cells) {
  Experiment e;
  e.mesh = make_box({{0, 0, 0}}, {{0.1, 0.1, 0.2}}, {cells, cells, 2 * cells});
  e.density.assign(e.mesh.tets.size(), 1000);
  e.fixed = at_bottom(e.mesh);
  LoadCase load{.name = "weight", .group = "weight", .gravity = {{1, 0, -9.81}}};
  for (const Triangle& t : boundary_triangles(e.mesh, 0, e.mesh.tet_count())) {
    if (e.mesh.rest[t[0]][2] < 0.19 || e.mesh.rest[t[1]][2] < 0.19 || e.mesh.rest[t[2]][2] < 0.19) continue;
    load.positions.push_back({static_cast<int>(e.markers.size()), {}, {{1e-5, 1e-5, 1e-5}}});
    e.markers.push_back({t, {0.6, 0.3, 0.1}});
    load.positions.push_back({static_cast<int>(e.markers.size()), {}, {{1e-5, 1e-5, 1e-5}}});
    e.markers.push_back({t, {0.3, 0.4, 0.3}});
  }
  e.cases.push_back(load);
  return e;
}

Vec3d place(const SurfacePoint& p, const TetMesh& mesh) {
  Vec3d x{};
  for (int i = 0; i < 3; ++i) x = x + p.weights[i] * mesh.rest[p.vertices[i]];
  return x;
}

std::vector<MaterialParameters> material(const Experiment& e) {
  return std::vector<MaterialParameters>(e.mesh.tets.size(), {lame_from_young_poisson(kColumnYoung, 0.3), {}});
}

// Mean sag of the top corners, which all meshes have.
double sag(const Experiment& e) {
  const auto parameters = material(e);
  LoadedBody body(e, e.cases[0], "neo_hookean", parameters, {});
  EXPECT_TRUE(body.solve(parameters, {}));
  double sum = 0;
  for (int v = 0; v < e.mesh.vertex_count(); ++v) {
    const Vec3d& X = e.mesh.rest[v];
    const bool is_corner = X[2] > 0.199 && (X[0] < 1e-9 || X[0] > 0.0999) && (X[1] < 1e-9 || X[1] > 0.0999);
    if (is_corner) sum += (body.x()[3 * v + 2] - X[2]) / 4;
  }
  return sum;
}

TEST(RefinedExperiment, HasTheSameBodyMarkersAndHolds) {
  const Experiment coarse = column(2), fine = refined(coarse);
  EXPECT_EQ(fine.mesh.tet_count(), 8 * coarse.mesh.tet_count());
  EXPECT_EQ(fine.mesh.vertex_count(), 5 * 5 * 9) << "no vertex is there twice";
  EXPECT_EQ(fine.fixed.size(), 25u);
  for (int t = 0; t < fine.mesh.tet_count(); ++t)
    EXPECT_NEAR(volume(fine.mesh, t), volume(coarse.mesh, t / 8) / 8, 1e-12);
  std::set<std::set<int>> surface;
  for (const Triangle& t : boundary_triangles(fine.mesh, 0, fine.mesh.tet_count()))
    surface.insert({t.begin(), t.end()});
  ASSERT_EQ(fine.markers.size(), coarse.markers.size());
  for (size_t m = 0; m < fine.markers.size(); ++m) {
    const Vec3d d = place(fine.markers[m], fine.mesh) - place(coarse.markers[m], coarse.mesh);
    EXPECT_NEAR(norm(d), 0, 1e-15);
    const auto& v = fine.markers[m].vertices;
    EXPECT_TRUE(surface.contains({v.begin(), v.end()})) << "a marker lies on a triangle of the surface";
    for (const double w : fine.markers[m].weights) EXPECT_GE(w, -1e-12);
  }
}

TEST(RefinedExperiment, PredictsTheLimitOfFineMeshes) {
  // Between meshes of 3 and 12 cells a quadratic error decreases to a sixteenth.
  const Experiment coarse = column(3);
  const MeshErrors errors = mesh_errors(coarse, "neo_hookean", material(coarse));
  ASSERT_EQ(errors.cases.size(), 1u) << errors.failure;
  double mean = 0;
  for (const Vec3d& e : errors.cases[0].markers) mean += e[2] / static_cast<double>(errors.cases[0].markers.size());
  const double difference = sag(column(12)) - sag(coarse);
  EXPECT_LT(difference, 0) << "linear tets are too stiff";
  EXPECT_NEAR(mean, 16.0 / 15 * difference, 0.15 * std::abs(difference));
}

int iterations(const Predictions& predictions) { return predictions.cases.at(0).solve.iterations; }

TEST(RefinedExperiment, PredictionsStartFromTheLastOnes) {
  for (const bool is_quadratic : {false, true}) {
    Experiment coarse = column(2);
    if (is_quadratic) coarse.mesh = raise_order(coarse.mesh);
    coarse.cases[0].gravity = {{2, 0, -2}};
    coarse.fixed = at_bottom(coarse.mesh);
    const Experiment fine = refined(coarse);
    const auto of = [&](const Experiment& e) { return of_tets(e, material(coarse)); };
    const Predictions cold = predicted(fine, "neo_hookean", of(fine));
    ErrorPredictions last;
    ASSERT_EQ(mesh_errors(coarse, "neo_hookean", material(coarse), {}, &last).failure, "");
    EXPECT_LT(iterations(last.on_fine_mesh), iterations(cold)) << "starts from the interpolated equilibrium";
    const Vec3d first = last.on_fine_mesh.cases[0].markers[0];
    EXPECT_NEAR(norm(first - cold.cases[0].markers[0]), 0, 1e-7 * norm(first));
    ASSERT_EQ(mesh_errors(coarse, "neo_hookean", material(coarse), {}, &last).failure, "");
    EXPECT_LE(iterations(last.on_mesh), 1);
    EXPECT_LE(iterations(last.on_fine_mesh), 1);
    EXPECT_NEAR(norm(last.on_fine_mesh.cases[0].markers[0] - first), 0, 1e-7 * norm(first));
  }
}

TEST(RefinedExperiment, PositionsOfQuadraticTetsAreInterpolatedByTheirShapeFunctions) {
  const TetMesh coarse = raise_order(column(1).mesh);
  Experiment e;
  e.mesh = coarse;
  const TetMesh fine = refined(e).mesh;
  const auto moved = [](const TetMesh& mesh) {
    std::vector<double> x;
    for (const Vec3d& X : mesh.rest) x.insert(x.end(), {X[0] + X[1] * X[2], X[1] - X[0] * X[0], 2 * X[2]});
    return x;
  };
  const std::vector<double> x = prolonged(coarse, fine, moved(coarse)), exact = moved(fine);
  ASSERT_EQ(x.size(), exact.size());
  for (size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(x[i], exact[i], 1e-14);
}

TEST(RefinedExperiment, ErrorsCorrectMeasurementsAndIncreaseTheirSigma) {
  Experiment e = column(2);
  MeshErrors errors{{MeshError{}}, ""};
  errors.cases[0].markers.assign(e.markers.size(), Vec3d{{3e-5, 0, 0}});
  const Experiment better = without_mesh_errors({e}, errors);
  EXPECT_DOUBLE_EQ(better.cases[0].positions[0].position[0], -3e-5);
  EXPECT_DOUBLE_EQ(better.cases[0].positions[0].position[1], 0);
  EXPECT_NEAR(better.cases[0].positions[0].sigma[1], std::sqrt(2.0) * 1e-5, 1e-12);
}

// Parallel forces, for which the mesh gives 0.8 (or 2.5) times the limit of fine meshes.
Experiment pushed(double measured) {
  Experiment e = column(2);
  e.cases[0].positions.clear();
  e.cases[0].force = Vec3d{{0, 0, measured}};
  e.cases[0].force_sigma = {{0.1, 0.1, 0.1}};
  return e;
}

MeshErrors errors_of_force(double on_mesh, double in_limit) {
  MeshErrors errors{{MeshError{}}, ""};
  errors.cases[0].on_mesh.force = {{0, 0, on_mesh}};
  errors.cases[0].wrench.force = {{0, 0, in_limit - on_mesh}};
  return errors;
}

TEST(RefinedExperiment, CorrectedForcesKeepTheirSign) {
  for (const double on_mesh : {-0.8, -2.5})
    for (const double measured : {-24.2, -2.0, -0.2, -0.01, 0.0}) {
      const LoadCase load = without_mesh_errors({pushed(measured)}, errors_of_force(on_mesh, -1)).cases[0];
      EXPECT_LE((*load.force)[2], 0) << measured << " N where the mesh has " << on_mesh << " N of -1 N";
      EXPECT_LE(std::abs((*load.force)[2]), 2.5 * std::abs(measured) + 1e-12);
    }
}

TEST(RefinedExperiment, CorrectionsScaleWithTheForce) {
  const MeshErrors errors = errors_of_force(-0.8, -1);
  for (const double measured : {-0.05, -1.0, -5.0}) {
    const LoadCase load = without_mesh_errors({pushed(measured)}, errors).cases[0];
    EXPECT_NEAR((*load.force)[2], 0.8 * measured, 1e-12);
    EXPECT_NEAR(load.force_sigma[2], std::hypot(0.1, 0.2 * measured / 3), 1e-12);
    EXPECT_NEAR(errors.cases[0].for_wrench_on_mesh({{{0, 0, 0.8 * measured}}, {}}).force[2], 0.2 * measured, 1e-12)
        << "the mesh error is added to predictions again";
  }
  EXPECT_DOUBLE_EQ(errors.cases[0].relative_force_error(), 0.25);
}

// A twist: forces are round-off, and their ratios mean nothing.
TEST(RefinedExperiment, ATwistIsScaledByItsTorque) {
  Experiment e = pushed(3e-9);
  e.cases[0].torque = Vec3d{{0, 0, 0.5}};
  e.cases[0].torque_sigma = {{0.01, 0.01, 0.01}};
  MeshErrors errors = errors_of_force(1e-9, 7e-9);
  errors.cases[0].on_mesh.torque = {{0, 0, 1.1}};
  errors.cases[0].wrench.torque = {{0, 0, -0.1}};
  EXPECT_NEAR((*without_mesh_errors({e}, errors).cases[0].torque)[2], 0.55, 1e-12);
  EXPECT_NEAR(errors.cases[0].factor(), 1 / 1.1, 1e-12);
}

// A pull of a symmetric body: torques on the mesh are errors of the mesh.
TEST(RefinedExperiment, TorquesAddedByTheMeshAreSubtracted) {
  Experiment e = pushed(-1);
  e.cases[0].torque = Vec3d{{-1e-5, 0, 0}};
  MeshErrors errors = errors_of_force(-1.25, -1);
  errors.cases[0].on_mesh.torque = {{2e-3, 0, 0}};
  errors.cases[0].wrench.torque = {{-2e-3, 0, 0}};
  EXPECT_NEAR((*without_mesh_errors({e}, errors).cases[0].torque)[0], 2e-3, 1e-4);
  EXPECT_NEAR(errors.cases[0].for_wrench_on_mesh({{{0, 0, -1.25}}, {{2e-3, 0, 0}}}).torque[0], -2e-3, 1e-12);
}

TEST(RefinedExperiment, ReportsWhyErrorsAreMissing) {
  Experiment e = column(2);
  e.cases[0].gravity = {{0, 0, -1e5}};  // crushes it
  const std::vector<MaterialParameters> soft(e.mesh.tets.size(), {lame_from_young_poisson(1e-3, 0.3), {}});
  const MeshErrors errors = mesh_errors(e, "neo_hookean", soft, {.max_iterations = 3});
  EXPECT_TRUE(errors.cases.empty());
  EXPECT_FALSE(errors.failure.empty());
}

}  // namespace
}  // namespace aspic
