// Energy balances of every integrator.
#include "dynamics/ledger.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dynamics/models_test.h"
#include "reference/integrators.h"

namespace aspic {
namespace {

using namespace testing_models;

double largest_term(const StepReport& report) {
  double largest = std::abs(report.kinetic);
  for (const double V : report.potential) largest = std::max(largest, std::abs(V));
  return largest;
}

void expect_closed(const SimulationOptions& options) {
  Simulation simulation = simulate(damped_beam_with_moving_pins_and_targets(), options);
  double largest = 0, pin_work = 0, damping_loss = 0;
  double energy = simulation.kinetic_energy(), flows = 0;
  for (const double V : simulation.potential_energies()) energy += V;
  for (int i = 0; i < 20; ++i) {
    const StepReport report = simulation.step();
    ASSERT_TRUE(is_success(report.status)) << options.integrator << " " << to_string(report.status);
    largest = std::max(largest, largest_term(report));
    pin_work += std::abs(report.pin_work);
    damping_loss += report.damping_loss;
    EXPECT_LT(std::abs(report.ledger_error), 1e-11 * largest) << options.integrator;
    ASSERT_EQ(report.target_work.size(), simulation.model().loads.size());
    EXPECT_EQ(report.target_work.front(), 0) << "gravity has no moving target";
    EXPECT_NE(report.target_work.back(), 0) << "the pulled spring has a moving target";
    flows += report.pin_work - report.damping_loss - report.numerical_loss + report.residual_work;
    // Energies at the end of a step equal those at the start of the next one.
    EXPECT_NEAR(report.kinetic + report.potential_total, energy + flows, 1e-10 * largest) << options.integrator;
  }
  EXPECT_GT(pin_work, 0) << options.integrator;
  if (options.integrator != "quasi_static") {
    EXPECT_GT(damping_loss, 0) << options.integrator;
  }
}

TEST(Ledger, BalancesForEveryIntegrator) {
  for (const std::string& integrator : integrator_names())
    expect_closed({.h = is_explicit(integrator) ? 1e-4 : 0.01, .integrator = integrator, .solver = {}});
}

TEST(Ledger, BalancesOverSubsteps) {
  for (const std::string& integrator : adaptive_integrator_names())
    expect_closed({.h = is_explicit(integrator) ? 4e-4 : 0.01,
                   .integrator = integrator,
                   .adaptive = {.tolerance = 1e-4},
                   .solver = {}});
}

TEST(Ledger, ResidualIsBelowThreshold) {
  for (const std::string& integrator : integrator_names()) {
    if (is_explicit(integrator) || integrator == "linearly_implicit_euler") continue;
    Simulation simulation =
        simulate(damped_beam_with_moving_pins_and_targets(), {.integrator = integrator, .solver = {}});
    for (int i = 0; i < 10; ++i) {
      const StepReport report = simulation.step();
      ASSERT_EQ(report.status, Status::converged) << integrator;
      EXPECT_GT(report.residual_threshold, 0) << integrator;
      EXPECT_LE(report.residual, report.residual_threshold * (1 + 1e-6)) << integrator << " step " << i;
    }
  }
}

TEST(Ledger, ExplicitResidualEqualsThatOfMassSolves) {
  for (const std::string& integrator : integrator_names()) {
    if (!is_explicit(integrator)) continue;
    Simulation simulation =
        simulate(damped_beam_with_moving_pins_and_targets(), {.h = 1e-4, .integrator = integrator, .solver = {}});
    const double weight = 9.81 * simulation.model().mass->total();
    for (int i = 0; i < 10; ++i) EXPECT_LT(simulation.step().residual, 1e-9 * weight) << integrator;
  }
}

TEST(Ledger, MidpointConservesEnergyOfLinearForces) {
  Simulation simulation = oscillator({.h = 0.05, .integrator = "midpoint", .solver = {}},
                                     {.damping = 1, .offset = [](double t) { return 3 * t; }});
  double work = 0;
  for (int i = 0; i < 50; ++i) {
    const StepReport report = simulation.step();
    EXPECT_LT(std::abs(report.numerical_loss), 1e-12 * 200);  // four springs of 50 J
    work += report.pin_work;
  }
  EXPECT_GT(work, 1);
}

TEST(Ledger, BackwardEulerLosesHalfOfVelocityJump) {
  Model model = make_model(make_box({{0, 0, 0}}, {{1, 1, 1}}, {1, 1, 1}), {});
  Simulation simulation = simulate(std::move(model));
  const double mass = simulation.model().mass->total(), jump = 9.81 * 0.01;
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(simulation.step().numerical_loss, mass * jump * jump / 2, 1e-7);
}

// Returns the report of the last of `steps` steps of a beam that falls under its weight.
StepReport last_step_of_beam(const char* integrator, double h, int steps) {
  Simulation simulation = simulate(beam(1, {.material = "arap"}), {.h = h, .integrator = integrator});
  StepReport report;
  for (int i = 0; i < steps; ++i) report = simulation.step();
  return report;
}

TEST(Ledger, ExplicitBlowUpIsNotSuccess) {
  for (const char* integrator : {"rk4", "symplectic_euler", "forward_euler"}) {
    const double stable = simulate(beam(1, {.material = "arap"}), {.integrator = integrator}).stable_step().h;
    const StepReport blown_up = last_step_of_beam(integrator, 1.2 * stable, 60);
    EXPECT_EQ(blown_up.status, Status::unstable) << integrator << ", " << blown_up.kinetic << " J";
  }
}

TEST(Ledger, StableExplicitRunIsSuccess) {
  for (const char* integrator : {"rk4", "symplectic_euler"}) {
    const double stable = simulate(beam(1, {.material = "arap"}), {.integrator = integrator}).stable_step().h;
    for (const int steps : {1, 20, 200})
      EXPECT_EQ(last_step_of_beam(integrator, 0.9 * stable, steps).status, Status::converged) << integrator;
  }
}

// A beam without weight whose far end is shaken by a pin, or by springs with moving targets. Returns the last of 60
// steps.
StepReport last_step_of_shaken_beam(bool by_pin, double part_of_stable_step) {
  const auto shaken = [by_pin] {
    Model model = beam(1, {.material = "arap"});
    const std::vector<int> end = vertices_where(model.mesh, [](const Vec3d& X) { return X[0] > 4 - 1e-9; });
    const auto shake = [](const Vec3d& X, double t) { return X + Vec3d{{0, 0.1 * std::sin(20 * t), 0}}; };
    if (by_pin) model.pins.push_back({"shaker", end, shake});
    if (!by_pin)
      model.loads.push_back(make_point_springs("pull", {{end[0], 500, [shake](double t) {
                                                           return shake(Vec3d{{4, 0, 0}}, t);
                                                         }}}));
    return model;
  };
  const double stable = simulate(shaken(), {.integrator = "symplectic_euler"}).stable_step().h;
  Simulation simulation = simulate(shaken(), {.h = part_of_stable_step * stable, .integrator = "symplectic_euler"});
  StepReport report;
  for (int i = 0; i < 60; ++i) report = simulation.step();
  return report;
}

TEST(Ledger, ChecksExplicitRunsWithMovingPinsAndTargets) {
  for (const bool by_pin : {true, false}) {
    EXPECT_EQ(last_step_of_shaken_beam(by_pin, 0.9).status, Status::converged) << by_pin;
    EXPECT_EQ(last_step_of_shaken_beam(by_pin, 1.2).status, Status::unstable) << by_pin;
  }
}

TEST(Ledger, ChecksExplicitRunEquallyAfterRestart) {
  const auto shaken = [] {
    return simulate(damped_beam_with_moving_pins_and_targets(), {.h = 1e-3, .integrator = "symplectic_euler"});
  };
  Simulation whole = shaken(), resumed = shaken();
  for (int i = 0; i < 5; ++i) whole.step();
  EXPECT_GT(whole.snapshot().outside_work, 0);
  resumed.restore(whole.snapshot());
  EXPECT_EQ(resumed.snapshot().outside_work, whole.snapshot().outside_work);
}

}  // namespace
}  // namespace aspic
