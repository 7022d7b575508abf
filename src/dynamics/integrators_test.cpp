// Compares each integrator with theory: damping and frequency, invariants, free fall.
#include "dynamics/integrator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "dynamics/models_test.h"
#include "reference/integrators.h"

namespace aspic {
namespace {

using namespace testing_models;

TEST(Integrators, MatchOscillatorFormulas) {
  EXPECT_EQ(expected_oscillations().size() + 1, integrator_names().size()) << "all except quasi_static";
  for (const auto& [integrator, expected] : expected_oscillations()) {
    const Oscillation measured = measured_oscillation(integrator);
    EXPECT_NEAR(measured.energy_left, expected.energy_left, 6e-7 * std::max(1.0, expected.energy_left)) << integrator;
    EXPECT_NEAR(measured.frequency_ratio, expected.frequency_ratio, 6e-6) << integrator;
  }
}

TEST(Integrators, EulerMethodsChangeEnergyByFixedFactors) {
  for (const auto& [integrator, factor] : {std::pair{"forward_euler", 1.01}, {"backward_euler", 1 / 1.01}}) {
    Simulation simulation = oscillator({.h = 0.01, .integrator = integrator, .solver = {}});
    for (int i = 0; i < 100; ++i) {
      const double before = oscillator_energy(simulation);
      simulation.step();
      EXPECT_NEAR(oscillator_energy(simulation) / before, factor, 1e-12) << integrator;
    }
  }
  Simulation simulation = oscillator({.h = 0.01, .integrator = "symplectic_euler", .solver = {}});
  const double E = oscillator_energy(simulation);
  // q moves with the new velocity, so the shadow energy includes + h/2 w^2 x v.
  const auto invariant = [&] {
    return oscillator_energy(simulation) -
           0.5 * 0.01 * 100 * oscillator_position(simulation) * oscillator_velocity(simulation);
  };
  for (int i = 0; i < 1000; ++i) {
    simulation.step();
    EXPECT_GE(oscillator_energy(simulation), .95238 * E);
    EXPECT_LE(oscillator_energy(simulation), 1.05264 * E);
    EXPECT_NEAR(invariant(), E, 1e-11 * E);
  }
}

TEST(Integrators, HaveOrderWithDampingAndMovingTarget) {
  for (const std::string& integrator : integrators_in_time()) {
    const double h = 0.004;
    EXPECT_NEAR(std::log2(driven_oscillator_error(integrator, h) / driven_oscillator_error(integrator, h / 2)),
                make_integrator(integrator)->facts().order, 0.1)
        << integrator;
  }
}

TEST(Integrators, MatchFreeFallFormulas) {
  for (const std::string& integrator : integrators_in_time())
    EXPECT_LT(free_fall_error(integrator, expected_fall(integrator, kFallSteps)), 1e-12) << integrator;
}

Model spinning_box(State& start) {
  Model model = make_model(make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 2, 2}), {.young = 1e4, .gravity = {}});
  start = at_rest(model.mesh);
  for (size_t i = 0; i < start.q.size(); i += 3) {
    start.qdot[i] = -6 * start.q[i + 1] + 2;
    start.qdot[i + 1] = 6 * start.q[i];
    start.q[i + 2] *= 1.2;
  }
  return model;
}

// Returns the sums of p and of x cross p.
std::pair<Vec3d, Vec3d> momenta(const Simulation& simulation) {
  std::vector<double> p(simulation.state().q.size());
  simulation.model().mass->multiply(simulation.state().qdot, p);
  Vec3d linear{}, angular{};
  for (size_t i = 0; i < p.size(); i += 3) {
    const double* q = &simulation.state().q[i];
    const Vec3d pi{{p[i], p[i + 1], p[i + 2]}};
    linear = linear + pi;
    angular = angular + cross(Vec3d{{q[0], q[1], q[2]}}, pi);
  }
  return {linear, angular};
}

TEST(Integrators, MidpointConservesLinearAndAngularMomentum) {
  State start;
  Model model = spinning_box(start);
  SimulationOptions options{.h = 0.02, .integrator = "midpoint", .solver = {}};
  options.solver.minimize.tolerance = 1e-13;
  Simulation simulation(std::move(model), start, options);
  const auto [linear, angular] = momenta(simulation);
  for (int i = 0; i < 50; ++i) {
    ASSERT_TRUE(is_success(simulation.step().status));
    const auto [p, L] = momenta(simulation);
    for (int r = 0; r < 3; ++r) {
      EXPECT_NEAR(p[r], linear[r], 1e-10 * 1000);
      EXPECT_NEAR(L[r], angular[r], 1e-10 * angular[2]);
    }
  }
}

TEST(Integrators, OrderByNumericalDampingOfStiffBody) {
  std::map<std::string, double> left;  // kinetic + potential energy after 50 steps, relative to the start
  for (const char* integrator : {"backward_euler", "bdf2", "tr_bdf2", "midpoint"}) {
    State start;
    Model model = spinning_box(start);
    Simulation simulation(std::move(model), start, {.h = 0.02, .integrator = integrator, .solver = {}});
    double energy = simulation.kinetic_energy(), lost = 0;
    for (const double V : simulation.potential_energies()) energy += V;
    for (int i = 0; i < 50; ++i) lost += simulation.step().numerical_loss;
    left[integrator] = 1 - lost / energy;
  }
  EXPECT_LT(left["backward_euler"], left["bdf2"]);
  EXPECT_LT(left["bdf2"], left["tr_bdf2"]);
  EXPECT_LT(left["tr_bdf2"], left["midpoint"]);
  EXPECT_NEAR(left["midpoint"], 1, 0.01);
}

}  // namespace
}  // namespace aspic
