// Steps with a time budget. The clocks are simulated: no test depends on real time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "base/error.h"
#include "dynamics/models_test.h"

namespace aspic {
namespace {

using namespace testing_models;

struct BudgetedStep {
  StepReport report;
  double first_value = 0;  // E at the initial guess of the last minimization
  double time = 0;         // duration of the step
  bool stopped_within_solve = false;
};

// Returns the second step of a soft beam, with a clock that advances by one per reading.
BudgetedStep step_within(double budget, SimulationOptions options) {
  double now = 0;
  options.h = 1.0 / 30;
  Simulation simulation = simulate(damped_beam_with_moving_pins_and_targets(), [&] {
    options.clock = [&now] { return now += 1; };
    return options;
  }());
  simulation.step();
  SolverOptions solver = options.solver;
  solver.time_budget = budget;
  simulation.set_solver(solver);
  BudgetedStep step;
  const double begin = now;
  bool observed = false;
  step.report = simulation.step([&](const LiveIteration& iteration) {
    observed = true;
    if (iteration.index == 0) step.first_value = iteration.value;
    step.stopped_within_solve = step.stopped_within_solve || (iteration.direction.stopped && iteration.alpha > 0);
  });
  step.time = now - begin;
  if (!observed) step.first_value = step.report.objective;
  return step;
}

const std::vector<std::string>& budgeted_integrators() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> found;
    for (const std::string& name : integrator_names()) {
      const auto integrator = make_integrator(name);
      if (integrator->facts().is_implicit && !integrator->facts().takes_one_iteration) found.push_back(name);
    }
    return found;
  }();
  return names;
}

// Checks that for any budget E decreases, the ledger is balanced, the state is finite, and the status names the cause.
void expect_sound(const BudgetedStep& step, const std::string& what) {
  const StepReport& report = step.report;
  EXPECT_TRUE(report.status == Status::budget || is_success(report.status)) << what << to_string(report.status);
  EXPECT_LE(report.objective, step.first_value + 1e-12 * std::abs(step.first_value)) << what;
  const double largest = std::abs(report.kinetic) + std::abs(report.potential_total) + std::abs(report.pin_work);
  EXPECT_LT(std::abs(report.ledger_error), 1e-10 * largest) << what;
}

TEST(TimeBudget, IsKeptByEveryIntegrator) {
  for (const std::string& integrator : budgeted_integrators()) {
    std::set<Status> ends;
    bool within_solve = false;
    for (double budget = 0.5; budget < 4000; budget = 1.3 * budget + 1) {
      const BudgetedStep step =
          step_within(budget, {.integrator = integrator, .solver = {.linear = "block_jacobi", .minimize = {}}});
      expect_sound(step, integrator + ", " + std::to_string(budget) + ": ");
      ends.insert(step.report.status);
      within_solve = within_solve || step.stopped_within_solve;
      if (step.report.status == Status::budget && budget > 10) {
        EXPECT_LT(step.time, budget + 12) << integrator;  // readings after the deadline
      }
    }
    EXPECT_TRUE(ends.contains(Status::budget) && ends.contains(Status::converged)) << integrator;
    EXPECT_TRUE(within_solve) << integrator;
  }
}

TEST(TimeBudget, IsKeptByEveryMethod) {
  for (const std::string& method : minimizer_names())
    for (const double budget : {0.5, 3.0, 10.0, 30.0, 100.0})
      expect_sound(step_within(budget, {.solver = {.method = method, .minimize = {.max_iterations = 100000}}}),
                   method + ", " + std::to_string(budget) + ": ");
}

TEST(TimeBudget, AmpleBudgetDoesNotChangeResult) {
  const auto state = [](double budget) {
    Simulation simulation = simulate(beam(2), {.solver = {.minimize = {}, .time_budget = budget}});
    for (int i = 0; i < 3; ++i) EXPECT_EQ(simulation.step().status, Status::converged);
    return simulation.state().q;
  };
  EXPECT_EQ(state(1e9), state(0));
}

TEST(TimeBudget, LargerBudgetEndsCloserToMinimum) {
  const SimulationOptions options{.solver = {.linear = "block_jacobi", .minimize = {}}};
  const double least = step_within(1e9, options).report.objective;
  const double little = step_within(20, options).report.objective;
  EXPECT_GT(little, least);
  EXPECT_GE(step_within(60, options).report.objective, least);
}

TEST(TimeBudget, IsRejectedByExplicitSchemes) {
  const auto refusal = [](SimulationOptions options) -> std::string {
    if (options.solver.time_budget == 0) options.solver.time_budget = 0.01;
    try {
      simulate(beam(1), options);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "no error";
  };
  using testing::AllOf, testing::HasSubstr;
  for (const char* integrator : {"rk4", "linearly_implicit_euler"})
    EXPECT_THAT(refusal({.integrator = integrator, .solver = {}}), AllOf(HasSubstr("budget"), HasSubstr(integrator)));
  EXPECT_THAT(refusal({.adaptive = {.tolerance = 1e-3}, .solver = {}}), HasSubstr("adaptive"));
  EXPECT_THAT(refusal({.solver = {.minimize = {}, .time_budget = -1}}), HasSubstr("positive"));
  SimulationOptions options;
  options.solver.minimize.line_search.test = DecreaseTest::none;
  EXPECT_THAT(refusal(options), HasSubstr("line search"));
}

}  // namespace
}  // namespace aspic
