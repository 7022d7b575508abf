#include "dynamics/mesh_error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "dynamics/mesh_error_text.h"
#include "dynamics/models_test.h"
#include "mesh/tet_nodes.h"
#include "reference/statics.h"

namespace aspic {
namespace {

using namespace testing_models;
using testing::HasSubstr;
using testing::StartsWith;

Simulation statics(Model model, double h = 1) {
  SimulationOptions options{.h = h, .integrator = "quasi_static"};
  options.solver.minimize.tolerance = 1e-10;
  return Simulation(std::move(model), std::move(options));
}

// Forces of a traction [Pa] on the faces of a box at the given x.
std::unique_ptr<Energy> traction(const TetMesh& mesh, double x, const Vec3d& t) {
  std::vector<double> force(3 * mesh.rest.size(), 0.0);
  for (const Triangle& face : boundary_triangles(mesh, 0, mesh.tet_count())) {
    const auto& X = mesh.rest;
    if (X[face[0]][0] != x || X[face[1]][0] != x || X[face[2]][0] != x) continue;
    const double area = norm(cross(X[face[1]] - X[face[0]], X[face[2]] - X[face[0]])) / 2;
    for (const int v : face)
      for (int r = 0; r < 3; ++r) force[3 * v + r] += area / 3 * t[r];
  }
  return make_linear_load("traction", std::move(force));
}

// 6 x 1 x 1 m, with `cells` across, clamped at x = 0.
ModelBuilder beam_of(int cells, double poisson, double young = 1e5) {
  const TetMesh mesh = make_box({{0, 0, 0}}, {{6, 1, 1}}, {6 * cells, cells, cells});
  ModelBuilder builder(mesh);
  builder.material("neo_hookean_log_j2", {.young = young, .poisson = poisson})
      .density(1000)
      .pin("clamp", [](const Vec3d& X) { return X[0] == 0; });
  return builder;
}

MeshErrorEstimate error_after(Simulation simulation, int steps = 1) {
  take_steps(simulation, steps, "equilibrium");
  return simulation.mesh_error();
}

// The exact solution is in the space of the linear tets: a bar under a traction, held without lateral constraint.
TEST(MeshError, IsZeroInThePatchTest) {
  const TetMesh mesh = make_box({{0, 0, 0}}, {{2, 1, 1}}, {3, 2, 2});
  ModelBuilder builder(mesh);
  builder.material("neo_hookean", {.young = 1e5, .poisson = 0.3}).density(0);
  for (int axis = 0; axis < 3; ++axis) {
    Vec3d normal{};
    normal[axis] = 1;
    builder.pin("plane", [axis](const Vec3d& X) { return X[axis] == 0; }, {}, {normal});
  }
  builder.load(traction(mesh, 2, {{2e4, 0, 0}}));
  const MeshErrorEstimate error = error_after(statics(builder.build()));
  ASSERT_EQ(error.reason, "");
  EXPECT_TRUE(error.is_reliable);
  EXPECT_LT(std::abs(error.bodies[0].stiffness), 1e-12);
}

// A column under its weight, Poisson's ratio 0: u is quadratic, so the estimate is exact. The body stores
// (density g)^2 A L^3 / (6 E).
TEST(MeshError, IsExactForAColumnUnderItsWeight) {
  for (const int n : {2, 5}) {
    ModelBuilder builder(make_box({{0, 0, 0}}, {{0.1, 0.1, 1}}, {1, 1, n}));
    builder.material("linear", {.young = 1e7, .poisson = 0})
        .density(1000)
        .gravity({{0, 0, -10}})
        .pin("foot", [](const Vec3d& X) { return X[2] == 0; })
        .pin("lateral", [](const Vec3d&) { return true; }, {}, {Vec3d{{1, 0, 0}}, Vec3d{{0, 1, 0}}});
    Model model = builder.build();
    model.pins[1].vertices = vertices_where(model.mesh, [](const Vec3d& X) { return X[2] > 0; });
    Simulation simulation = statics(std::move(model));
    take_steps(simulation, 1, "equilibrium");
    const MeshErrorEstimate error = simulation.mesh_error();
    ASSERT_EQ(error.reason, "");
    const double stored = simulation.potential_energies()[0], exact = 1e8 * 0.01 / 6e7;
    EXPECT_NEAR(error.bodies[0].energy / (exact - stored), 1, 5e-3) << n;  // the residual of the solve
    EXPECT_NEAR(error.bodies[0].stiffness / (exact / stored - 1), 1, 5e-3) << n;
  }
}

// Values of an independent program in Python with the same meshes; see the note on discretization errors.
TEST(MeshError, AgreesWithAnotherProgramForBeams) {
  const struct {
    int cells;
    double poisson, stiffness, truth;
  } cases[] = {{2, 0.3, 0.9430, 0.9571}, {2, 0.45, 2.2135, 2.2178}, {2, 0.49, 7.3047, 7.3255},
               {3, 0.3, 0.4458, 0.4507}, {3, 0.45, 1.0816, 1.0851}, {3, 0.49, 3.7873, 3.8019}};
  for (const auto& [cells, poisson, stiffness, truth] : cases) {
    ModelBuilder builder = beam_of(cells, poisson);
    builder.load(traction(make_box({{0, 0, 0}}, {{6, 1, 1}}, {6 * cells, cells, cells}), 6, {{0, 0, -2}}));
    const MeshErrorEstimate error = error_after(statics(builder.build()));
    ASSERT_EQ(error.reason, "");
    EXPECT_TRUE(error.is_reliable);
    EXPECT_NEAR(error.bodies[0].stiffness / stiffness, 1, 0.02) << cells << " cells, " << poisson;
    EXPECT_NEAR(error.bodies[0].stiffness / truth, 1, 0.05) << cells << " cells, " << poisson;
  }
}

// A beam that swings in its lowest mode, in a mesh that bends equally in both directions. Its inertia and its damping
// are weights of the quadratic tets.
TEST(MeshError, CountsInertiaAndMassDamping) {
  const auto swinging = [](double damping) {
    ModelBuilder builder(make_box({{0, 0, 0}}, {{6, 1, 1}}, {12, 2, 2}, BoxCut::five));
    builder.material("neo_hookean_log_j2", {.young = 1e5, .poisson = 0.3})
        .density(1000)
        .gravity({{0, 0, -1e-3}})
        .pin("clamp", [](const Vec3d& X) { return X[0] == 0; })
        .rayleigh_damping(damping, 0);
    return builder.build();
  };
  const double at_rest = error_after(statics(swinging(0))).bodies.at(0).stiffness;
  for (const double damping : {0.0, 0.2}) {
    const MeshErrorEstimate error = error_after(Simulation(swinging(damping), {.h = 0.2}), 20);
    ASSERT_EQ(error.reason, "");
    EXPECT_NEAR(error.bodies.at(0).stiffness / at_rest, 1, 0.1) << damping;
  }
}

TEST(MeshError, NeedsAStepWithDamping) {
  ModelBuilder builder = beam_of(1, 0.3);
  Simulation simulation(builder.gravity({{0, 0, -1}}).rayleigh_damping(1, 0).build());
  take_steps(simulation, 2, "swing");
  EXPECT_EQ(simulation.mesh_error().reason, "");
  simulation.restore(simulation.snapshot());
  EXPECT_THAT(simulation.mesh_error().reason, HasSubstr("take one first"));
}

TEST(MeshError, StatesWhyThereIsNone) {
  ModelBuilder quadratic(raise_order(make_box({{0, 0, 0}}, {{1, 1, 1}}, {1, 1, 1})));
  quadratic.material("neo_hookean", {.young = 1e5, .poisson = 0.3}).density(1000);
  EXPECT_THAT(Simulation(quadratic.build()).mesh_error().reason, HasSubstr("order = 2"));
  ModelBuilder viscous = beam_of(1, 0.3);
  viscous.gravity({{0, 0, -10}}).strain_rate_damping(1e4);
  EXPECT_THAT(error_after(Simulation(viscous.build()), 3).reason, HasSubstr("'strain_rate_damping'"));
  const Simulation at_rest(beam_of(1, 0.3).build());
  EXPECT_EQ(mesh_error_text(at_rest.mesh_error(), at_rest), "no estimate: nothing is strained");
}

TEST(MeshError, IsOneSentenceWithRemedy) {
  const Simulation bar(beam_of(1, 0.3).build());  // mean edge 1.3 m
  MeshErrorEstimate error{.is_reliable = true, .bodies = {{.energy = 1, .stiffness = 0.18, .motion = 0.15}}};
  EXPECT_EQ(mesh_error_text(error, bar),
            "makes 'body' about 18 % too stiff (displacements err by 15 %). `order = 2`, or edges of "
            "0.42 m instead of 1.3 m, would reach about 2 % where the solution is smooth. An estimate.");
  error.bodies[0].stiffness = 7.33;
  error.bodies[0].motion = std::nan("");
  EXPECT_THAT(mesh_error_text(error, bar),
              HasSubstr("about 730 % too stiff (displacements err by 88 %). `order = 2` would reach"));
  error.bodies[0] = {.stiffness = 0.06, .motion = 0.57};
  EXPECT_THAT(mesh_error_text(error, bar), HasSubstr("about 6 % too stiff (displacements err by 57 %). "
                                                     "`order = 2` would reach"));
  error.bodies[0] = {.stiffness = 0.004};
  error.is_reliable = false;
  EXPECT_EQ(mesh_error_text(error, bar),
            "makes 'body' less than 1 % too stiff. Unreliable: quadratic tets are unstable in "
            "this state. An estimate.");
}

// Tractions that differ between adjacent faces: an exact solution of linear tets.
TEST(MeshError, IsZeroUnderLoadsOnAdjacentFaces) {
  const TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 2, 2});
  std::vector<double> force(3 * mesh.rest.size(), 0.0);
  for (const Face& face : boundary_faces(mesh, 0, mesh.tet_count())) {
    const auto& [a, b, c] = face.corners;
    const Vec3d normal = cross(mesh.rest[b] - mesh.rest[a], mesh.rest[c] - mesh.rest[a]);
    add_traction(mesh.rest, face, (1 / norm(normal)) * Vec3d{{-2 * normal[0], 3 * normal[1], 0}}, force);
  }
  ModelBuilder builder(mesh);
  builder.material("linear", {.young = 1e5, .poisson = 0.3}).density(1).load(make_linear_load("traction", force));
  for (int axis = 0; axis < 3; ++axis) {
    Vec3d normal{};
    normal[axis] = 1;
    builder.pin("middle", [axis](const Vec3d& X) { return X[axis] == 0.5; }, {}, {normal});
  }
  const MeshErrorEstimate error = error_after(statics(builder.build()));
  ASSERT_EQ(error.reason, "");
  EXPECT_LT(std::abs(error.bodies[0].stiffness), 1e-6);
}

// A bar under a large pull along its axis and a small load across: k is small, but not the error of the displacement.
TEST(MeshError, OfDisplacementsCountsASmallLoadBesideALargeOne) {
  const TetMesh mesh = make_box({{0, 0, 0}}, {{6, 1, 1}}, {6, 1, 1});
  const auto tip = [](TetMesh of) {
    ModelBuilder builder(of);
    builder.material("linear", {.young = 1e5, .poisson = 0.3})
        .density(1000)
        .pin("clamp", [](const Vec3d& X) { return X[0] == 0; })
        .load(make_linear_load("traction",
                               verify::traction_on(of, [](const Vec3d& X) { return X[0] == 6; }, {{500, 0, -10}})));
    return builder.build();
  };
  const auto sag = [](const Simulation& simulation) {  // at a corner of the end
    const auto& X = simulation.model().mesh.rest;
    for (size_t v = 0; v < X.size(); ++v)
      if (X[v][0] == 6 && X[v][1] == 0 && X[v][2] == 0) return simulation.state().q[3 * v + 2];
    return 0.0;
  };
  Simulation linear = statics(tip(mesh)), quadratic = statics(tip(raise_order(mesh)));
  take_steps(linear, 1, "pull");
  take_steps(quadratic, 1, "pull");
  const BodyMeshError error = linear.mesh_error().bodies.at(0);
  EXPECT_LT(error.stiffness, 0.3);
  EXPECT_NEAR(error.motion, 1 - sag(linear) / sag(quadratic), 0.1);
}

}  // namespace
}  // namespace aspic
