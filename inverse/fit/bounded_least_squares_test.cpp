#include "fit/bounded_least_squares.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace aspic {
namespace {

// r = A p - b
struct LinearProblem : LeastSquares {
  int n, m;
  std::vector<double> A, b;  // row by row

  int parameter_count() const override { return n; }
  int residual_count() const override { return m; }
  bool evaluate(std::span<const double> p, std::span<double> r) override {
    multiply(p, r);
    for (int i = 0; i < m; ++i) r[i] -= b[i];
    return true;
  }
  bool linearize() override { return true; }
  void multiply(std::span<const double> dp, std::span<double> dr) override {
    for (int i = 0; i < m; ++i) {
      dr[i] = 0;
      for (int k = 0; k < n; ++k) dr[i] += A[i * n + k] * dp[k];
    }
  }
  void multiply_transposed(std::span<const double> w, std::span<double> pbar) override {
    for (int k = 0; k < n; ++k) {
      pbar[k] = 0;
      for (int i = 0; i < m; ++i) pbar[k] += A[i * n + k] * w[i];
    }
  }
};

LinearProblem random_problem(std::mt19937& random, int n, int m) {
  std::normal_distribution<double> normal;
  LinearProblem problem;
  problem.n = n, problem.m = m;
  for (int i = 0; i < n * m; ++i) problem.A.push_back(normal(random));
  for (int i = 0; i < m; ++i) problem.b.push_back(3 * normal(random));
  return problem;
}

TEST(MinimizeWithin, FulfilsTheConditionsOfTheConstrainedMinimum) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 50; ++trial) {
    LinearProblem problem = random_problem(random, 8, 20);
    const std::vector<Bounds> bounds(8, {0, 0.5});
    const std::vector<double> guess(8, 0.1);
    const BoundedFit fit = minimize_within(problem, guess, bounds);
    ASSERT_TRUE(fit.is_converged);
    std::vector<double> r(20), g(8);
    problem.evaluate(fit.p, r);
    problem.multiply_transposed(r, g);
    int held = 0;
    for (int i = 0; i < 8; ++i) {
      EXPECT_GE(fit.p[i], 0);
      EXPECT_LE(fit.p[i], 0.5);
      EXPECT_EQ(fit.at_bound[i], fit.p[i] == 0 || fit.p[i] == 0.5);
      held += fit.at_bound[i];
      if (fit.p[i] == 0) {
        EXPECT_GE(g[i], -1e-5);
      }
      if (fit.p[i] == 0.5) {
        EXPECT_LE(g[i], 1e-5);
      }
      if (!fit.at_bound[i]) {
        EXPECT_NEAR(g[i], 0, 1e-3);
      }
    }
    EXPECT_GT(held, 0);
  }
}

TEST(MinimizeWithin, HasTheSigmaOfLinearRegression) {
  // A line through n points with noise: var(slope) = s^2 / sum (x - mean)^2.
  std::mt19937 random(2);
  std::normal_distribution<double> noise(0, 0.1);
  LinearProblem line;
  line.n = 2, line.m = 200;
  double mean = 0, spread = 0;
  for (int i = 0; i < line.m; ++i) {
    const double x = 0.01 * i;
    line.A.insert(line.A.end(), {1, x});
    line.b.push_back(1 + 2 * x + noise(random));
    mean += x / line.m;
  }
  for (int i = 0; i < line.m; ++i) spread += std::pow(0.01 * i - mean, 2);
  const double inf = std::numeric_limits<double>::infinity();
  const std::vector<Bounds> bounds(2, {-inf, inf});
  const BoundedFit fit = minimize_within(line, std::vector<double>{0, 0}, bounds);
  const double s2 = 2 * fit.objective / (line.m - 2);
  EXPECT_NEAR(s2, 0.01, 0.002);
  EXPECT_NEAR(fit.sigma[1], std::sqrt(s2 / spread), 1e-6);
  EXPECT_NEAR(fit.p[1], 2, 4 * fit.sigma[1]);
}

TEST(MinimizeWithin, CallsWhatTheResidualsDoNotSeeUndetermined) {
  LinearProblem problem;  // only p0 + p1 matters; p2 has no effect
  problem.n = 3, problem.m = 4;
  problem.A = {1, 1, 0, 1, 1, 0, 1, 1, 0, 2, 2, 0};
  problem.b = {1, 1.1, 0.9, 2};
  const std::vector<Bounds> bounds(3, {-10, 10});
  const BoundedFit fit = minimize_within(problem, std::vector<double>{0, 0, 3}, bounds);
  EXPECT_NEAR(fit.p[0] + fit.p[1], 1, 1e-6);
  EXPECT_EQ(fit.p[2], 3);
  for (const double sigma : fit.sigma) EXPECT_TRUE(std::isinf(sigma));
}

// y = a exp(-b x) where large b makes the residuals undefined.
struct Decay : LeastSquares {
  double a = 0, b = 0;
  int parameter_count() const override { return 2; }
  int residual_count() const override { return 5; }
  bool evaluate(std::span<const double> p, std::span<double> r) override {
    if (p[1] > 4) return false;
    a = p[0], b = p[1];
    for (int i = 0; i < 5; ++i) r[i] = a * std::exp(-b * i) - 2 * std::exp(-0.7 * i);
    return true;
  }
  bool linearize() override { return true; }
  void multiply(std::span<const double> dp, std::span<double> dr) override {
    for (int i = 0; i < 5; ++i) dr[i] = std::exp(-b * i) * (dp[0] - a * i * dp[1]);
  }
  void multiply_transposed(std::span<const double> w, std::span<double> pbar) override {
    pbar[0] = pbar[1] = 0;
    for (int i = 0; i < 5; ++i) pbar[0] += std::exp(-b * i) * w[i], pbar[1] -= a * i * std::exp(-b * i) * w[i];
  }
};

TEST(MinimizeWithin, AvoidsPointsWithUndefinedResiduals) {
  Decay problem;
  const std::vector<Bounds> bounds = {{0, 100}, {0, 100}};
  const BoundedFit fit = minimize_within(problem, std::vector<double>{9, 3.9}, bounds);
  EXPECT_TRUE(fit.is_converged);
  EXPECT_NEAR(fit.p[0], 2, 1e-6);
  EXPECT_NEAR(fit.p[1], 0.7, 1e-6);
  const BoundedFit none = minimize_within(problem, std::vector<double>{9, 5}, bounds);
  EXPECT_FALSE(none.is_converged);
  EXPECT_TRUE(none.p.empty());
}

}  // namespace
}  // namespace aspic
