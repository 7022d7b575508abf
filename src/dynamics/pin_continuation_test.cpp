
#include <gtest/gtest.h>

#include "dynamics/models_test.h"
#include "energy/fibres.h"
#include "mesh/tet_nodes.h"

namespace aspic {
namespace {

using namespace testing_models;

// One end of a barrier-material beam moves further in one step than its elements are long.
Model carried(double distance) {
  Model model = beam(2, {.material = "neo_hookean_log", .young = 1e5, .gravity = {}});
  model.pins.push_back({"hand", vertices_where(model.mesh, [](const Vec3d& X) { return X[0] > 4 - 1e-9; }),
                        [distance](const Vec3d& X, double t) {
                          return X - Vec3d{{distance * t, 0, 0}};
                        }});
  return model;
}

TEST(PinContinuation, MovesPinsInFractionsWithBarrierMaterial) {
  for (const std::string integrator : {"backward_euler", "quasi_static"}) {
    Simulation simulation = simulate(carried(1.2), {.h = 1, .integrator = integrator, .solver = {}});
    const StepReport report = simulation.step();
    EXPECT_TRUE(is_success(report.status)) << integrator << " " << to_string(report.status);
    EXPECT_GT(report.min_det_F, 0);
    for (const int v : simulation.model().pins[1].vertices)
      EXPECT_EQ(simulation.state().q[3 * v], 4 - 1.2) << integrator;
  }
}

// A single move of the pins raises the energy of the fibres to 1e300 J, which Newton's method would reduce by a
// constant factor per iteration.
TEST(PinContinuation, OneLargeStepOfExponentialFibresEndsLikeSmallOnes) {
  const auto stretched = [](int steps, double distance) {
    const TetMesh mesh = raise_order(make_box({}, {{0.04, 0.01, 0.01}}, {8, 2, 2}));
    Fibre fibre{{}, 2e3, 20, 0};
    fibre.directions.fill((1 / std::sqrt(1.09)) * Vec3d{{1, 0.3, 0}});
    Model model = model_of(mesh, {.material = "neo_hookean_log_j2", .young = 9e3, .poisson = 0.49, .gravity = {}})
                      .pin("left", [](const Vec3d& X) { return X[0] < 1e-9; })
                      .pin(
                          "right", [](const Vec3d& X) { return X[0] > 0.04 - 1e-9; },
                          [distance](const Vec3d& X, double t) {
                            return X + Vec3d{{distance * t, 0, 0}};
                          })
                      .load(make_fibres({"fibres", mesh}, std::vector<Fibre>(mesh.tets.size(), fibre)))
                      .build();
    Simulation simulation = simulate(std::move(model), {.h = 1.0 / steps, .integrator = "quasi_static", .solver = {}});
    for (int i = 0; i < steps; ++i) {
      const StepReport report = simulation.step();
      // The fibres bend the coarse elements until some of them invert between their nodes.
      EXPECT_EQ(report.status, report.min_det_F > 0 ? Status::converged : Status::inverted) << i;
      EXPECT_LT(report.iterations, 150);
    }
    return simulation.potential_energies();
  };
  for (const double distance : {0.01, 0.02}) {  // 25 and 50 %
    const std::vector<double> once = stretched(1, distance), often = stretched(20, distance);
    for (size_t k = 0; k < often.size(); ++k) EXPECT_NEAR(once[k], often[k], 1e-6 * std::abs(often[k])) << distance;
  }
}

TEST(PinContinuation, InvertingPinsEndUndefined) {
  Model model = beam(2, {.gravity = {}});
  model.pins.push_back({"mirror", vertices_where(model.mesh, [](const Vec3d& X) { return X[0] > 3 - 1e-9; }),
                        [](const Vec3d& X, double t) {
                          return X + Vec3d{{t * (7 - 2 * X[0]), 0, 0}};
                        }});
  Simulation simulation = simulate(std::move(model), {.h = 1, .integrator = "quasi_static", .solver = {}});
  EXPECT_EQ(simulation.step().status, Status::undefined);
}

}  // namespace
}  // namespace aspic
