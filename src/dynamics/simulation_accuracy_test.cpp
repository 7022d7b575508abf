// Uniform stretch, whose solution is known exactly.
#include "dynamics/simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dynamics/models_test.h"

namespace aspic {
namespace {

using namespace testing_models;

struct UniaxialRow {
  std::string material;
  double poisson, stretch, lateral, nominal_stress;
};

// Prescribes an affine stretch on the boundary of a box and solves for the interior.
TEST(Simulation, UniaxialStretchPassesPatchTest) {
  const std::vector<UniaxialRow> rows = {{"neo_hookean_log", .3, .5, 1.21076739, -0.93535206},
                                         {"neo_hookean_log", .3, 1.5, 0.88017459, 0.37828018},
                                         {"neo_hookean", .3, 2, 0.77459667, 0.65384615},
                                         {"neo_hookean", .45, 1.5, 0.82999331, 0.35887612}};
  for (const UniaxialRow& row : rows) {
    TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {3, 3, 3});
    const auto on_boundary = [](const Vec3d& X) {
      return std::any_of(X.a, X.a + 3, [](double c) { return c < 1e-9 || c > 1 - 1e-9; });
    };
    for (Vec3d& X : mesh.rest)
      if (!on_boundary(X)) X = X + Vec3d{{0.05 * std::sin(9 * X[1]), 0.04 * std::cos(7 * X[2]), -0.03}};
    Model model = make_model(mesh, {.material = row.material, .young = 1, .poisson = row.poisson, .gravity = {}});
    const auto stretched = [row](const Vec3d& X) {
      return Vec3d{{row.stretch * X[0], row.lateral * X[1], row.lateral * X[2]}};
    };
    model.pins.push_back({"boundary", vertices_where(model.mesh, on_boundary),
                          [stretched](const Vec3d& X, double t) { return (1 - t) * X + t * stretched(X); }});
    SimulationOptions options{.h = 0.25, .integrator = "quasi_static", .solver = {}};
    options.solver.minimize.tolerance = 1e-14;
    Simulation simulation = simulate(std::move(model), options);
    for (int i = 0; i < 4; ++i) ASSERT_TRUE(is_success(simulation.step().status)) << row.material;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
      const Vec3d exact = stretched(mesh.rest[v]);
      for (int r = 0; r < 3; ++r) EXPECT_NEAR(simulation.state().q[3 * v + r], exact[r], 1e-10);
    }
    const TetFields fields = simulation.tet_fields();
    for (int t = 0; t < mesh.tet_count(); ++t) {
      // Cauchy sigma = P lambda / J = P / t^2 along the bar, and zero across. The table states t to 5e-9, which the
      // stiffness (up to about 10 E across the bar at nu = .45) converts to stress.
      EXPECT_NEAR(fields.cauchy[6 * t] * row.lateral * row.lateral, row.nominal_stress, 5e-8) << row.material;
      EXPECT_NEAR(fields.cauchy[6 * t + 1], 0, 5e-8) << row.material;
    }
  }
}

}  // namespace
}  // namespace aspic
