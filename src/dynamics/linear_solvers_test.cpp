// Properties of all linear solvers: the same solution, bit-reproducible for any number of threads and after restarts.
#include "linalg/linear_solver.h"

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "dynamics/models_test.h"

namespace aspic {
namespace {

using namespace testing_models;

// 1 029 vertices, more than multigrid factorizes on its coarsest level; stiff, so that the choice of `auto` matters.
Simulation stiff_beam(const std::string& linear) {
  return simulate(beam(6, {.young = 1e8}), {.h = 0.02, .solver = {.linear = linear, .minimize = {.tolerance = 1e-9}}});
}

std::vector<double> positions_after(Simulation& simulation, int steps) {
  for (int i = 0; i < steps; ++i) EXPECT_TRUE(is_success(simulation.step().status));
  return simulation.state().q;
}

class EveryLinearSolver : public testing::TestWithParam<std::string> {};

TEST_P(EveryLinearSolver, YieldsSameMotion) {
  Simulation exact = stiff_beam("cholesky"), simulation = stiff_beam(GetParam());
  const std::vector<double> expected = positions_after(exact, 3), q = positions_after(simulation, 3);
  for (size_t i = 0; i < q.size(); ++i) ASSERT_NEAR(q[i], expected[i], 1e-8) << i;
}

TEST_P(EveryLinearSolver, IsBitReproducibleOverThreads) {
  const int before = thread_count();
  std::vector<double> first;
  for (const int threads : {1, 2, 3, 8}) {
    set_thread_count(threads);
    Simulation simulation = stiff_beam(GetParam());
    const std::vector<double> q = positions_after(simulation, 3);
    if (threads == 1) first = q;
    EXPECT_EQ(q, first) << threads << " threads";
  }
  set_thread_count(before);
}

TEST_P(EveryLinearSolver, IsBitReproducibleAfterRestart) {
  Simulation whole = stiff_beam(GetParam());
  std::vector<Simulation::Snapshot> snapshots;
  for (int i = 0; i < 4; ++i) {
    snapshots.push_back(whole.snapshot());
    whole.step();
  }
  for (int i = 0; i < 4; ++i) {
    Simulation resumed = stiff_beam(GetParam());
    resumed.restore(snapshots[i]);
    EXPECT_EQ(positions_after(resumed, 4 - i), whole.state().q) << "from step " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Solvers, EveryLinearSolver, testing::ValuesIn(linear_solver_names()),
                         [](const auto& solver) { return solver.param; });

}  // namespace
}  // namespace aspic
