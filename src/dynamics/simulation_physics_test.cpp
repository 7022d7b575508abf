// Energy, units and rest of simulations; `verify` checks further properties.
#include "dynamics/simulation.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "dynamics/models_test.h"
#include "energy/rayleigh_damping.h"

namespace aspic {
namespace {

using namespace testing_models;

TEST(Simulation, BenchmarkBeamReachesReferenceDisplacement) {
  SimulationOptions options;
  options.solver.minimize.criterion = Criterion::first_gradient;
  Simulation simulation = simulate(beam(7), options);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(simulation.step().status, Status::converged);
  const int indenter = 28 * 8 * 8;  // (4, 0, 0)
  EXPECT_NEAR(simulation.state().q[3 * indenter + 1], -0.0539775432, 1e-8);
}

TEST(Simulation, BackwardEulerLosesForwardEulerGainsEnergy) {
  for (const auto& [integrator, sign] : {std::pair{"backward_euler", 1.0}, {"forward_euler", -1.0}}) {
    Model model = make_model(make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 2, 2}), {.young = 1e4, .gravity = {}});
    State start = at_rest(model.mesh);
    for (size_t i = 0; i < start.q.size(); i += 3) start.q[i] *= 1.1;
    Simulation simulation(std::move(model), start, {.h = 1e-3, .integrator = integrator, .solver = {}});
    double loss = 0;
    for (int i = 0; i < 50; ++i) loss += simulation.step().numerical_loss;
    EXPECT_GT(sign * loss, 0) << integrator;
  }
}

// The same beam in units of length a, of modulus and density b: lengths scale with a, times with a.
TEST(Simulation, IsIndependentOfUnits) {
  const auto run = [](double a, double b) {
    TetMesh mesh = make_box({{0, 0, 0}}, {{4 * a, a, a}}, {8, 2, 2});
    Model model = make_model(mesh, {.young = 1e5 * b, .density = 1000 * b, .gravity = {{0, -9.81 / a, 0}}});
    model.pins.push_back({"wall", vertices_where(mesh, [a](const Vec3d& X) { return X[0] < 1e-9 * a; }), {}});
    Simulation simulation = simulate(std::move(model), {.h = 0.02 * a, .integrator = "backward_euler", .solver = {}});
    std::vector<double> result;
    for (int i = 0; i < 10; ++i) result.push_back(simulation.step().iterations);
    for (const double q : simulation.state().q) result.push_back(q / a);
    return result;
  };
  const std::vector<double> meters = run(1, 1);
  for (const auto& [a, b] : {std::pair{1e-3, 1.0}, {1e3, 1.0}, {1.0, 1e-3}, {1.0, 1e6}}) {
    const std::vector<double> scaled = run(a, b);
    for (size_t i = 0; i < meters.size(); ++i) EXPECT_NEAR(scaled[i], meters[i], 1e-9) << a << " " << b;
  }
}

TEST(Simulation, DampedBodyComesToRest) {
  Model model = beam(1, {.material = "neo_hookean", .young = 1e6});
  model.damping.push_back(make_rayleigh_damping(*model.mass, 4, nullptr, 0));  // about critical
  Simulation simulation = simulate(std::move(model), {.h = 0.02, .integrator = "backward_euler", .solver = {}});
  for (int i = 0; i < 500; ++i) ASSERT_TRUE(is_success(simulation.step().status));
  EXPECT_LT(simulation.kinetic_energy(), 1e-8);
}

}  // namespace
}  // namespace aspic
