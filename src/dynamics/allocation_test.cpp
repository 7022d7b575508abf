#include "allocation_counter.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/parallel.h"
#include "dynamics/models_test.h"
#include "linalg/linear_solver.h"

namespace aspic {
namespace {

using namespace testing_models;

// Checks steps with all terms, moving pins, moving targets and damping.
void expect_steady_steps_to_allocate_only_their_report(const SimulationOptions& options) {
  Simulation simulation = simulate(damped_beam_with_moving_pins_and_targets(4), options);
  for (int i = 0; i < 2; ++i) simulation.step();
  for (int i = 0; i < 3; ++i) {
    const test::AllocationCounter counter;
    const StepReport report = simulation.step();
    EXPECT_EQ(counter.count(), 5) << options.integrator << ", " << options.solver.method << ", "
                                  << options.solver.linear << ": allocates more than the vectors of StepReport";
    EXPECT_TRUE(is_success(report.status) || report.status == Status::iteration_limit) << to_string(report.status);
  }
}

TEST(Allocations, AreZeroInSteadyStepsOfLinearSolvers) {
  const int before = thread_count();
  for (const int threads : {1, 2, 8})
    for (const std::string& linear : linear_solver_names()) {
      set_thread_count(threads);
      expect_steady_steps_to_allocate_only_their_report({.solver = {.linear = linear, .minimize = {}}});
    }
  set_thread_count(before);
}

TEST(Allocations, AreZeroInSteadyStepsOfIntegrators) {
  for (const std::string& integrator : integrator_names()) {
    expect_steady_steps_to_allocate_only_their_report(
        {.h = is_explicit(integrator) ? 5e-5 : 0.01, .integrator = integrator, .solver = {}});
  }
}

TEST(Allocations, AreZeroWhenPinsStartToMove) {
  Model model = damped_beam_with_moving_pins_and_targets(4);
  model.pins.back().motion = [](const Vec3d& X, double t) { return X + Vec3d{{0, std::max(0.0, t - 0.035), 0}}; };
  Simulation simulation = simulate(std::move(model), {.solver = {}});  // h = 0.01
  for (int i = 0; i < 6; ++i) {
    const test::AllocationCounter counter;
    const StepReport report = simulation.step();
    EXPECT_TRUE(i < 2 || counter.count() == 5) << "step " << report.step << ": " << counter.count();
  }
}

TEST(Allocations, AreZeroInSteadyStepsOfMethods) {
  for (const std::string& method : minimizer_names())
    for (const std::string& preconditioner : preconditioner_names())
      for (const std::string& definiteness : definiteness_names()) {
        SimulationOptions options{
            .solver = {.method = method, .preconditioner = preconditioner, .definiteness = definiteness}};
        if (find_conflict(options.solver)) continue;
        options.solver.minimize.max_iterations = 5;
        expect_steady_steps_to_allocate_only_their_report(options);
      }
}

TEST(Allocations, AreZeroInSteadyStepsWithFallbacks) {
  SimulationOptions options{.solver = {.method = "newton", .fallback = {"lbfgs", "gradient_descent"}}};
  options.solver.minimize.max_iterations = 5;
  expect_steady_steps_to_allocate_only_their_report(options);
}

}  // namespace
}  // namespace aspic
