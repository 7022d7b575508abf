#include "allocation_counter.h"

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "linalg/linear_solver.h"
#include "linalg/matrices_test.h"

namespace aspic {
namespace {

using namespace test;

TEST(AllocationCounter, CountsVector) {
  const AllocationCounter counter;
  const std::vector<int> v(100, 1);
  EXPECT_EQ(v.back(), 1);
  EXPECT_EQ(counter.count(), 1);
}

class Allocations : public testing::TestWithParam<std::string> {};

TEST_P(Allocations, AreZeroInProductRefactorizationAndSolve) {
  const Matrix H = spring_lattice({.nx = 20, .ny = 12, .nz = 12, .stiffness = 10});  // 3 549 rows: two chunks
  const std::vector<double> b = random_vector(3 * H.rows(), 1);
  std::vector<double> x(b.size());
  const int threads = thread_count();
  for (const int count : {1, 2}) {
    set_thread_count(count);
    const auto solver = make_linear_solver(GetParam());
    solver->analyze(*H.pattern);
    ASSERT_TRUE(solver->factorize(H.values));
    ASSERT_TRUE(solver->solve(b, x, 1e-6).ok);
    const AllocationCounter counter;
    H.values.multiply(b, x);
    const bool definite = solver->factorize(H.values);
    const SolveReport report = solver->solve(b, x, 1e-6);
    EXPECT_EQ(counter.count(), 0) << count << " threads";
    EXPECT_TRUE(definite && report.ok);
  }
  set_thread_count(threads);
}

INSTANTIATE_TEST_SUITE_P(Every, Allocations, testing::ValuesIn(linear_solver_names()),
                         [](const auto& instance) { return instance.param; });

}  // namespace
}  // namespace aspic
