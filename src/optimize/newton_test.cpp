#include "optimize/newton.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "optimize/minimize.h"
#include "optimize/test_functions.h"

namespace aspic {
namespace {

std::unique_ptr<Newton> newton() { return std::make_unique<Newton>(make_linear_solver("block_jacobi")); }

MinimizeReport minimize_from_afar(SearchDirection& direction, Criterion criterion, std::vector<double>& x,
                                  const IterationObserver& observe = {}) {
  Rosenbrock f;
  x = {-0.8, 0.6, 0};
  MinimizeOptions options;
  options.criterion = criterion;
  options.tolerance = 1e-5;
  return Minimizer().minimize(f, direction, x, options, observe);
}

TEST(Newton, KeepsHessianForLastIterations) {
  for (const std::string linear : {"cholesky", "block_jacobi", "multigrid", "auto"}) {
    std::vector<double> x;
    Newton direction(make_linear_solver(linear));
    const MinimizeReport report = minimize_from_afar(direction, Criterion::absolute, x);
    EXPECT_EQ(report.status, Status::converged);
    EXPECT_LT(report.hessians, report.iterations) << linear;
    EXPECT_EQ(report.factorizations, report.hessians) << linear;
    EXPECT_NEAR(x[0], 1, 2.5e-5) << linear;  // the smallest eigenvalue of the Hessian at (1, 1) is 0.399
  }
}

TEST(Newton, ComputesHessianForDirectionCriteria) {
  std::vector<double> x;
  for (const Criterion criterion : {Criterion::decrement, Criterion::velocity, Criterion::acceleration}) {
    const MinimizeReport report = minimize_from_afar(*newton(), criterion, x);
    EXPECT_GE(report.hessians, report.iterations) << to_string(criterion);
  }
}

TEST(Newton, KeepsHessianDespiteObserver) {
  std::vector<double> plain, watched;
  const MinimizeReport expected = minimize_from_afar(*newton(), Criterion::absolute, plain);
  const MinimizeReport report =
      minimize_from_afar(*newton(), Criterion::absolute, watched, [](const LiveIteration& iteration) {
        const std::vector<double> elsewhere = {3, -2, 0};
        iteration.E.hessian(elsewhere, {Definiteness::clamped});
      });
  EXPECT_EQ(watched, plain);
  EXPECT_EQ(report.hessians, expected.hessians);
  EXPECT_EQ(report.gradient_round_off, expected.gradient_round_off);
}

TEST(Newton, DropsHessianBetweenMinimizations) {
  Rosenbrock f;
  const auto direction = newton();
  const std::vector<double> x = {1.01, 1.02, 0};
  std::vector<double> g(3), d(3);
  f.gradient(x, g);
  const InnerAccuracy large = {.loosest = 0.1, .enough = 10};  // for any accuracy of the last quadratic approximation
  const auto hessians = [&] {
    DirectionReport report;
    EXPECT_TRUE(direction->compute({f, x, g, large}, d, report));
    EXPECT_EQ(report.kept, report.hessians == 0);
    return report.hessians;
  };
  direction->begin();
  EXPECT_EQ(hessians(), 1);
  EXPECT_EQ(hessians(), 0);
  EXPECT_TRUE(direction->fall_back());
  EXPECT_EQ(hessians(), 1);
  EXPECT_EQ(hessians(), 0);
  direction->begin();
  EXPECT_EQ(hessians(), 1);
}

// A clamped eigenvalue is almost zero, which makes the step along it huge; its absolute value is a usable scale.
TEST(Newton, OnDemandUsesAbsoluteEigenvaluesAfterOvershoot) {
  std::vector<int> trials;
  const auto count = [&](const Iteration& iteration) { return trials.push_back(iteration.trials), true; };
  for (const auto definiteness : {NewtonDefiniteness::clamped, NewtonDefiniteness::on_demand}) {
    TwoBump f;
    Newton direction(make_linear_solver("block_jacobi"), definiteness);
    const MinimizeOptions options{.tolerance = 1e-10, .criterion = Criterion::absolute};
    std::vector<double> x = {-0.2, 1, 0};
    trials.clear();
    EXPECT_EQ(Minimizer().minimize(f, direction, x, options, count).status, Status::converged);
    EXPECT_EQ(trials.front() > 10, definiteness == NewtonDefiniteness::clamped) << trials.front();
    EXPECT_NEAR(x[0], -std::sqrt(0.5), 1e-8);
  }
  EXPECT_EQ(trials.front(), 1);
}

// A saddle at (0, 0) between minima at x = -1 and x = 1.
class DoubleWell : public PlanarFunction {
 public:
  double at(const Planar& p) const override { return p[0] * p[0] * (p[0] * p[0] / 2 - 1) + p[1] * p[1]; }
  Planar gradient_at(const Planar& p) const override { return {2 * p[0] * (p[0] * p[0] - 1), 2 * p[1]}; }
  PlanarHessian hessian_at(const Planar& p) const override { return {.xx = 6 * p[0] * p[0] - 2, .xy = 0, .yy = 2}; }
};

// As in contact: bounds of steps are at most 1.
class BoundedDoubleWell : public DoubleWell {
 public:
  double max_step(std::span<const double> x, std::span<const double> d) override {
    return std::min(1.0, (1.5 - x[0]) / std::max(d[0], 1e-300));
  }
};

void expect_to_leave_saddle_quickly(DoubleWell&& f) {
  Newton direction(make_linear_solver("cholesky"));
  std::vector<double> x = {1e-6, 0.1, 0};
  const MinimizeOptions options{.tolerance = 1e-10, .criterion = Criterion::absolute};
  const MinimizeReport report = Minimizer().minimize(f, direction, x, options);
  EXPECT_EQ(report.status, Status::converged);
  EXPECT_LT(report.iterations, 12);
  EXPECT_NEAR(x[0], 1, 1e-9);
}

// Each step with absolute eigenvalues doubles the distance from the saddle, which would take 20 steps.
TEST(Newton, OnDemandLeavesSaddleInFewIterations) {
  expect_to_leave_saddle_quickly(DoubleWell());
  expect_to_leave_saddle_quickly(BoundedDoubleWell());
}

class CountedTwoBump : public TwoBump {
 public:
  Evaluation evaluate(std::span<const double> x) override { return ++values, TwoBump::evaluate(x); }
  int values = 0;
};

// Without a line search that compares values of E, no value is evaluated in advance.
TEST(Newton, CountsAdvanceEvaluations) {
  const std::vector<double> x = {-0.2, 1, 0};
  const auto evaluations = [&](bool is_known) {
    CountedTwoBump f;
    Newton direction(make_linear_solver("block_jacobi"));
    std::vector<double> g(3), d(3);
    f.gradient(x, g);
    DirectionReport report;
    InnerAccuracy accuracy;
    if (is_known) accuracy.value = f.TwoBump::evaluate(x).value;
    direction.begin();
    EXPECT_TRUE(direction.compute({f, x, g, accuracy}, d, report));
    EXPECT_TRUE(report.projected);
    EXPECT_EQ(report.values, f.values);
    return std::pair(f.values, d);
  };
  const auto with_value = evaluations(true), without = evaluations(false);
  EXPECT_GE(with_value.first, 1);
  EXPECT_EQ(without.first, 0);

  CountedTwoBump f;
  Newton direction(make_linear_solver("block_jacobi"));
  std::vector<double> y = x;
  int trials = 0, ahead = 0;
  const auto count = [&](const Iteration& iteration) {
    trials += iteration.trials, ahead += iteration.direction.values;
  };
  const MinimizeReport report = Minimizer().minimize(f, direction, y, {.criterion = Criterion::absolute}, count);
  EXPECT_GT(ahead, 0);
  EXPECT_GE(ahead, report.projected_hessians);
  EXPECT_EQ(f.values, 1 + trials + ahead);
  EXPECT_EQ(report.values, f.values);
}

}  // namespace
}  // namespace aspic
