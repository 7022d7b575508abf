// Counts of the evaluations of a step: known values are not evaluated again.
#include <gtest/gtest.h>

#include "dynamics/models_test.h"

namespace aspic {
namespace {

using namespace testing_models;

TEST(Counts, NewtonEvaluatesNothingTwice) {
  Simulation simulation = simulate(beam(3, {.young = 1e5}));
  for (int i = 0; i < 5; ++i) {
    const StepReport report = simulation.step();
    ASSERT_EQ(report.status, Status::converged);
    ASSERT_EQ(report.projected_hessians, 0);
    EXPECT_GE(report.iterations, 1);
    EXPECT_EQ(report.trials, report.iterations);
    const int candidates = i == 0 ? 2 : 3;  // current, extrapolated, and after the first step accelerated
    EXPECT_EQ(report.values, candidates + report.trials);
    EXPECT_EQ(report.gradients, 1 + report.iterations);
    EXPECT_GE(report.hessians, 1);
    EXPECT_LT(report.hessians, report.iterations);  // one is reused for the last iterations
    EXPECT_EQ(report.factorizations, report.hessians);
    EXPECT_EQ(report.elements, simulation.model().mesh.tet_count());
  }
}

TEST(Counts, ResumedRunEqualsWholeRun) {
  Simulation whole = simulate(beam(2));
  whole.step();
  const Simulation::Snapshot snapshot = whole.snapshot();
  const StepReport expected = whole.step();
  Simulation resumed = simulate(beam(2));
  resumed.restore(snapshot);
  const StepReport report = resumed.step();
  EXPECT_EQ(report.values, expected.values);
  EXPECT_EQ(report.gradients, expected.gradients);
  EXPECT_EQ(report.hessians, expected.hessians);
  EXPECT_EQ(report.products, expected.products);
}

TEST(Counts, IgnoreEvaluationsOfObservers) {
  Simulation alone = simulate(beam(2)), watched = simulate(beam(2));
  for (int i = 0; i < 3; ++i) {
    const StepReport expected = alone.step();
    const StepReport report = watched.step([](const LiveIteration& iteration) {
      std::vector<double> g(iteration.x.size());
      iteration.E.value(iteration.x);
      iteration.E.gradient(iteration.x, g);
    });
    EXPECT_EQ(report.values, expected.values);
    EXPECT_EQ(report.gradients, expected.gradients);
    EXPECT_EQ(report.kinetic, expected.kinetic);
    EXPECT_EQ(report.numerical_loss, expected.numerical_loss);
  }
}

TEST(Counts, ExplicitStepEvaluatesForcesOncePerStage) {
  for (const auto& [integrator, stages] : {std::pair{"symplectic_euler", 1}, std::pair{"rk4", 4}}) {
    Simulation simulation = simulate(beam(2), {.h = 1e-4, .integrator = integrator, .solver = {}});
    simulation.step();
    const StepReport report = simulation.step();
    EXPECT_EQ(report.gradients, stages) << integrator;
    EXPECT_EQ(report.values, 1) << integrator;  // for the ledger
    EXPECT_EQ(report.hessians, 0) << integrator;
  }
}

TEST(Counts, MatrixProductsEqualThoseOfSolves) {
  const auto step = [](const std::string& linear) {
    return simulate(beam(3), {.solver = {.linear = linear, .minimize = {}}}).step();
  };
  const StepReport iterative = step("block_jacobi");
  EXPECT_GE(iterative.products, iterative.linear_iterations);
  EXPECT_EQ(iterative.cycles, 0);
  EXPECT_EQ(step("cholesky").linear_iterations, 0);
}

}  // namespace
}  // namespace aspic
