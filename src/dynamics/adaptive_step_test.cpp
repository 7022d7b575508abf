#include "dynamics/adaptive_step.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dynamics/models_test.h"
#include "reference/integrators.h"

namespace aspic {
namespace {

using namespace testing_models;

// x'' = -100 x, released at 1. The diagonal of the tet's bounding box at rest is sqrt(3) m.
const double kSize = std::sqrt(3.0);

struct Outcome {
  double error = 0;  // error of the position after the last step [m]
  int substeps = 0, rejected = 0, least = 1 << 20, most = 0;
};

Outcome run(const std::string& integrator, double tolerance, double h = 0.1, int steps = 10) {
  Simulation simulation = oscillator({.h = h, .integrator = integrator, .adaptive = {tolerance}, .solver = {}});
  Outcome result;
  for (int i = 0; i < steps; ++i) {
    const StepReport report = simulation.step();
    EXPECT_TRUE(is_success(report.status)) << integrator << " " << to_string(report.status);
    result.substeps += report.substeps;
    result.rejected += report.rejected;
    result.least = std::min(result.least, report.substeps);
    result.most = std::max(result.most, report.substeps);
  }
  result.error = std::abs(oscillator_position(simulation) - std::cos(10 * h * steps));
  return result;
}

TEST(AdaptiveStep, MeetsToleranceWithEveryScheme) {
  for (const std::string& integrator : adaptive_integrator_names()) {
    const bool first_order = make_integrator(integrator)->facts().order == 1;
    const double tolerance = first_order ? 1e-3 : 1e-5;
    const Outcome result = run(integrator, tolerance);
    // Sum of the errors of ten steps, which an oscillator neither damps nor amplifies; the estimate is asymptotic.
    EXPECT_LT(result.error, 10 * tolerance * kSize * 1.5) << integrator;
    EXPECT_GT(result.error, 0.02 * tolerance * kSize) << integrator << ": more accurate than necessary";
    EXPECT_GT(result.substeps, 20) << integrator;
    EXPECT_GT(result.rejected, 0) << integrator << ": the first attempt, at h, must be rejected";
  }
}

TEST(AdaptiveStep, SubstepCountFollowsOrder) {
  // The error of a whole step is proportional to (length of its substeps)^order.
  for (const auto& [integrator, order] : {std::pair{"forward_euler", 1}, {"midpoint", 2}, {"rk4", 4}}) {
    const double factor = order == 4 ? 1e-6 : 1e-2;
    const Outcome coarse = run(integrator, order == 1 ? 1e-2 : 1e-3),
                  fine = run(integrator, (order == 1 ? 1e-2 : 1e-3) * factor);
    EXPECT_NEAR(std::log(static_cast<double>(fine.substeps) / coarse.substeps) / std::log(1 / factor), 1.0 / order,
                0.12 / order)
        << integrator;
  }
}

TEST(AdaptiveStep, SubstepsGrowInCalmMotion) {
  // The target moves abruptly at t = 1 s, for about 0.05 s, and slowly otherwise.
  const auto jerk = [](double t) { return 20 * std::exp(-std::pow((t - 1) / 0.03, 2)); };
  for (const auto& [integrator, tolerance] : {std::pair{"backward_euler", 1e-3}, {"tr_bdf2", 1e-4}, {"rk4", 1e-7}}) {
    Simulation simulation = oscillator({.h = 0.1, .integrator = integrator, .adaptive = {tolerance}, .solver = {}},
                                       {.stiffness = 1, .offset = jerk});
    std::vector<int> substeps, rejected;
    for (int i = 0; i < 20; ++i) {
      const StepReport report = simulation.step();
      ASSERT_TRUE(is_success(report.status)) << integrator;
      substeps.push_back(report.substeps);
      rejected.push_back(report.rejected);
    }
    EXPECT_GE(substeps[9], 4 * substeps[5]) << integrator;
    EXPECT_GT(rejected[9] + rejected[8], 0) << integrator;
    EXPECT_LE(substeps[18], 2 * substeps[5]) << integrator;
    EXPECT_EQ(rejected[15], 0) << integrator;
  }
}

TEST(AdaptiveStep, ExplicitSchemeIsStableInLongSteps) {
  for (const char* integrator : {"symplectic_euler", "rk4"}) {
    const SimulationOptions options{.h = 0.05, .integrator = integrator, .adaptive = {1e-3}, .solver = {}};
    Simulation simulation = simulate(beam(2, {.material = "neo_hookean_log"}), options);
    const double longest = simulation.stable_step().h;
    ASSERT_GT(options.h, 5 * longest);
    int rejected = 0;
    for (int i = 0; i < 3; ++i) {
      const StepReport report = simulation.step();
      ASSERT_TRUE(is_success(report.status)) << integrator << " " << to_string(report.status);
      EXPECT_GT(report.substeps, 0.9 * options.h / longest) << integrator;
      rejected += report.rejected;
    }
    EXPECT_GT(rejected, 0) << integrator;
    EXPECT_EQ(simulation.state().time, 3 * 0.05);
  }
}

TEST(AdaptiveStep, UnreachableToleranceKeepsState) {
  Simulation simulation = oscillator({.h = 0.1, .integrator = "forward_euler", .adaptive = {1e-15}, .solver = {}});
  const State before = simulation.state();
  const StepReport report = simulation.step();
  EXPECT_EQ(report.status, Status::inaccurate);
  EXPECT_FALSE(is_success(report.status));
  EXPECT_EQ(report.rejected, 20);
  EXPECT_EQ(simulation.state().q, before.q);
  EXPECT_EQ(simulation.state().time, 0.1);
}

TEST(AdaptiveStep, ReportsStatusOfFailedSubstep) {
  for (const char* integrator : {"rk4", "tr_bdf2"}) {
    Simulation simulation = oscillator({.h = 0.1, .integrator = integrator, .adaptive = {1e-3}, .solver = {}},
                                       {.offset = [](double t) { return t > 0 ? NAN : 0.0; }});
    const StepReport report = simulation.step();
    EXPECT_EQ(report.status, Status::undefined) << integrator;
    EXPECT_EQ(report.rejected, 20) << integrator;
    EXPECT_EQ(oscillator_position(simulation), 1) << integrator;
  }
}

TEST(AdaptiveStep, InterruptsExplicitSchemeBetweenSubsteps) {
  const SimulationOptions options{.h = 0.1, .integrator = "rk4", .adaptive = {1e-9}, .solver = {}};
  Simulation disturbed = oscillator(options), undisturbed = oscillator(options);
  int asked = 0;
  EXPECT_EQ(disturbed.step({}, StopToken([&] { return ++asked >= 5; })).status, Status::interrupted);
  EXPECT_EQ(asked, 5);
  EXPECT_EQ(disturbed.steps_taken(), 0);
  EXPECT_EQ(disturbed.state().q, undisturbed.state().q);
  disturbed.step();
  EXPECT_GT(undisturbed.step().rejected, 0);
  EXPECT_EQ(disturbed.state().q, undisturbed.state().q) << "the repeated step differs";
}

TEST(AdaptiveStep, RestartsInterruptedStepFromSameState) {
  const SimulationOptions options{.integrator = "tr_bdf2", .adaptive = {1e-5}, .solver = {}};
  Simulation smooth = simulate(damped_beam_with_moving_pins_and_targets(), options);
  Simulation disturbed = simulate(damped_beam_with_moving_pins_and_targets(), options);
  int seen = 0;
  const auto count = [&](const Iteration&) { ++seen; };
  EXPECT_EQ(disturbed.step(count, StopToken([&] { return seen == 16; })).status, Status::interrupted);
  EXPECT_EQ(disturbed.steps_taken(), 0);
  EXPECT_EQ(disturbed.state().time, 0);
  for (int i = 0; i < 2; ++i) {
    const StepReport a = smooth.step(), b = disturbed.step();
    EXPECT_EQ(a.substeps, b.substeps);
    EXPECT_EQ(a.rejected, b.rejected);
    EXPECT_EQ(smooth.state().q, disturbed.state().q);
  }
}

TEST(AdaptiveStep, FollowsMovingPinsWithEveryScheme) {
  for (const std::string& integrator : adaptive_integrator_names()) {
    Simulation simulation = simulate(
        damped_beam_with_moving_pins_and_targets(),
        {.h = is_explicit(integrator) ? 1e-3 : 0.02, .integrator = integrator, .adaptive = {1e-4}, .solver = {}});
    for (int i = 0; i < 5; ++i) {
      const StepReport report = simulation.step();
      ASSERT_TRUE(is_success(report.status)) << integrator << " " << to_string(report.status);
      EXPECT_LT(report.substeps, 1000) << integrator;
    }
  }
}

}  // namespace
}  // namespace aspic
