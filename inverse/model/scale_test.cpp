// Necessity of a force: V is proportional to all moduli, so argmin V under prescribed positions does not depend on
// their scale. Shown for equilibria under large deformation.
#include <gtest/gtest.h>

#include <cmath>

#include "dynamics/models_test.h"
#include "indenter/probe.h"
#include "mesh/surface.h"
#include "model/equilibrium.h"

namespace aspic {
namespace {

using namespace testing_models;

constexpr double kSize = 0.1;  // of the cube [m]
const EquilibriumOptions kScaleExact{.tolerance = 1e-13, .adjoint_tolerance = 1e-13};

std::vector<MaterialParameters> uneven(int tets, double factor) {
  std::vector<MaterialParameters> parameters;
  for (int t = 0; t < tets; ++t)
    parameters.push_back({lame_from_young_poisson(factor * 1e4 * std::exp(std::sin(5 * t)), 0.45), {}});
  return parameters;
}

Model gel_cube(const Vec3d& gravity = {}) {
  return model_of(make_box({{0, 0, 0}}, {{kSize, kSize, kSize}}, {4, 4, 4}),
                  {.material = "stable_neo_hookean", .young = 1e4, .poisson = 0.45, .gravity = gravity})
      .pin("floor", [](const Vec3d& X) { return X[2] < 1e-9; })
      .build();
}

std::vector<double> solved_with_factor(Equilibrium& body, double factor) {
  body.set_parameters(uneven(body.model().mesh.tet_count(), factor));
  EXPECT_TRUE(is_success(body.solve().status)) << body.failure();
  return {body.x().begin(), body.x().end()};
}

TEST(Scale, OfModuliMovesNothingWithPrescribedPositions) {
  Model model = gel_cube();
  const auto pushed = [](const Vec3d& X) {
    return X[2] > kSize - 1e-9 && std::abs(X[0] - kSize / 2) < 0.03 && std::abs(X[1] - kSize / 2) < 0.03;
  };
  model.pins.push_back({"tip", vertices_where(model.mesh, pushed), [](const Vec3d& X, double) {
                          return X + Vec3d{{0.01, 0.005, -0.02}};
                        }});
  const std::vector<double> rest = at_rest(model.mesh).q;
  Equilibrium body(std::move(model), rest, kScaleExact);
  const std::vector<double> x = solved_with_factor(body, 1);
  const double motion = largest_difference(x, rest);
  EXPECT_GT(motion, 0.019);
  body.set_x(rest);
  EXPECT_LT(largest_difference(solved_with_factor(body, 10), x), 1e-10 * motion);
}

TEST(Scale, IsSeenWhereThereIsAWeight) {
  Model model = gel_cube({{0, 0, -9.81}});
  const std::vector<double> rest = at_rest(model.mesh).q;
  Equilibrium body(std::move(model), rest, kScaleExact);
  const std::vector<double> x = solved_with_factor(body, 1);
  EXPECT_GT(largest_difference(solved_with_factor(body, 10), x), 0.5 * largest_difference(x, rest));
}

struct Indented {
  Probe* probe = nullptr;  // of the body
  std::vector<double> rest;
  std::unique_ptr<Equilibrium> body;

  explicit Indented(double layer) {
    Model model = gel_cube();
    const Indenter indenter{.shape = IndenterShape::disc, .radius = 0.025, .stiffness = layer * 1e4 / 0.025};
    const IndenterPose touch{.center = {{kSize / 2, kSize / 2, kSize}}};
    auto term = make_probe(model.mesh, boundary_triangles(model.mesh, 0, model.mesh.tet_count()), indenter, touch);
    probe = term.get();
    probe->set_pose({.center = touch.center + Vec3d{{0.002, 0, -0.008}}, .rotation = {{0, 0.1, 0}}});
    model.loads.push_back(std::move(term));
    rest = at_rest(model.mesh).q;
    body = std::make_unique<Equilibrium>(std::move(model), rest, kScaleExact);
  }
};

TEST(Scale, OfModuliAndProbeLayerMovesNothing) {
  Indented soft(100), stiff(1000);  // the layer ten times stiffer
  const std::vector<double> x = solved_with_factor(*soft.body, 1), y = solved_with_factor(*stiff.body, 10);
  const double motion = largest_difference(x, soft.rest);
  EXPECT_LT(largest_difference(y, x), 1e-10 * motion);
  // The force is ten times larger.
  const Wrench at_x = soft.probe->wrench(x), at_y = stiff.probe->wrench(y);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(at_y.force[i], 10 * at_x.force[i], 1e-8 * std::abs(at_y.force[2]));
}

// With a fixed layer the scale leaks into positions for any layer stiffness, because the glue fades out to zero.
// Treating the layer stiffness as a nuisance removes this from the residuals.
TEST(Scale, LeaksThroughTheLayer) {
  for (const double layer : {1e2, 1e3, 1e4}) {
    Indented indented(layer);
    const std::vector<double> x = solved_with_factor(*indented.body, 1);
    const double leak =
        largest_difference(solved_with_factor(*indented.body, 2), x) / largest_difference(x, indented.rest);
    EXPECT_GT(leak, 1e-3) << layer;
    EXPECT_LT(leak, 0.1) << layer;
  }
}

// dx/dlog E + dx/dlog k = 0, exactly.
TEST(Scale, AndTheLayersStiffnessHaveOppositeTangents) {
  Indented indented(100);
  const std::vector<double> x = solved_with_factor(*indented.body, 1);
  ASSERT_TRUE(indented.body->factorize());
  std::vector<double> dtheta, by_young(x.size()), force(x.size(), 0.0), by_layer(x.size());
  for (const MaterialParameters& m : uneven(indented.body->model().mesh.tet_count(), 1))
    dtheta.insert(dtheta.end(), {m.lame.mu, m.lame.lambda});
  ASSERT_TRUE(indented.body->tangent(dtheta, by_young).ok);
  indented.probe->add_gradient(x, -1, force);
  ASSERT_TRUE(indented.body->solve_stiffness(force, by_layer).ok);
  double size = 0, sum = 0;
  for (size_t i = 0; i < x.size(); ++i) {
    size = std::max(size, std::abs(by_young[i]));
    sum = std::max(sum, std::abs(by_young[i] + by_layer[i]));
  }
  EXPECT_GT(size, 1e-5);
  EXPECT_LT(sum, 1e-8 * size);
}

}  // namespace
}  // namespace aspic
