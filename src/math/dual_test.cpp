#include "math/dual.h"

#include <gtest/gtest.h>

#include <random>

#include "math/polar3.h"

namespace aspic::dual_tests {
namespace {

using D = Dual<double>;
using DD = Dual<D>;

const double a = 1.25, da = 0.7;
const D x(a, da);

void expect_equal(const D& f, double value, double rate) {
  EXPECT_NEAR(f.value, value, 1e-14);
  EXPECT_NEAR(f.rate, rate, 1e-14);
}

TEST(Dual, ObeysArithmeticAndChainRules) {
  expect_equal(x * x * x - 2.0 * x, a * a * a - 2 * a, (3 * a * a - 2) * da);
  expect_equal(1.0 / x, 1 / a, -da / (a * a));
  expect_equal(-x / (x + 1.0), -a / (a + 1), -da / ((a + 1) * (a + 1)));
  expect_equal(sqrt(x), std::sqrt(a), da / (2 * std::sqrt(a)));
  expect_equal(cbrt(x), std::cbrt(a), std::cbrt(a) / (3 * a) * da);
  expect_equal(exp(x), std::exp(a), std::exp(a) * da);
  expect_equal(log(x), std::log(a), da / a);
  expect_equal(pow(x, -2.5), std::pow(a, -2.5), -2.5 * std::pow(a, -3.5) * da);
  expect_equal(abs(-x), a, da);
  expect_equal(max(x, D(2.0)), 2, 0);
}

TEST(Dual, NestedGivesMixedSecondDerivatives) {
  const DD y(D(a, 1.0), D(1.0, 0.0));  // both directions are the variable x
  EXPECT_NEAR((y * y * y).rate.rate, 6 * a, 1e-14);
  EXPECT_NEAR(log(y).rate.rate, -1 / (a * a), 1e-14);
  EXPECT_NEAR(sqrt(y).rate.rate, -0.25 * std::pow(a, -1.5), 1e-14);
  EXPECT_NEAR((1.0 / y).rate.rate, 2 / (a * a * a), 1e-14);
}

Mat3d random_matrix(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-0.4, 0.4);
  Mat3d A = identity3<double>();
  for (double& entry : A.a) entry += uniform(random);
  return A;
}

TEST(Dual, ClosestRotationHasFirstAndSecondDerivatives) {
  const Mat3d F = random_matrix(1), U = random_matrix(2), W = random_matrix(3);
  const auto along = [&](double u, double w) { return closest_rotation(F + u * U + w * W); };
  const auto second = closest_rotation(dual_matrix(dual_matrix(F, U), constant_matrix(W)));
  constexpr double h = 1e-4;
  for (int i = 0; i < 9; ++i) {
    EXPECT_NEAR(second.a[i].value.rate, (along(h, 0).a[i] - along(-h, 0).a[i]) / (2 * h), 1e-7);
    const double mixed = along(h, h).a[i] - along(h, -h).a[i] - along(-h, h).a[i] + along(-h, -h).a[i];
    EXPECT_NEAR(second.a[i].rate.rate, mixed / (4 * h * h), 1e-6);
  }
}

}  // namespace
}  // namespace aspic::dual_tests
