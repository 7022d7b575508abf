
#include <gtest/gtest.h>

#include "dynamics/models_test.h"

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

TEST(LeadPins, MovesPinsInFractionsWithBarrierMaterial) {
  for (const std::string integrator : {"backward_euler", "quasi_static"}) {
    Simulation simulation = simulate(carried(1.2), {.h = 1, .integrator = integrator, .solver = {}});
    const StepReport report = simulation.step();
    EXPECT_TRUE(is_success(report.status)) << integrator << " " << to_string(report.status);
    EXPECT_GT(report.min_det_F, 0);
    for (const int v : simulation.model().pins[1].vertices)
      EXPECT_EQ(simulation.state().q[3 * v], 4 - 1.2) << integrator;
  }
}

TEST(LeadPins, InvertingPinsEndUndefined) {
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
