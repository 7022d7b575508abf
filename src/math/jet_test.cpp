#include "math/jet.h"

#include <gtest/gtest.h>

#include <random>

namespace aspic::jet_tests {
namespace {

// f(x, y) of the first two variables, with manually computed derivatives.
struct Expansion {
  double value, x, y, xx, xy, yy;
};

void expect_equal(const Jet<double>& f, const Expansion& e) {
  EXPECT_NEAR(f.value, e.value, 1e-14);
  EXPECT_NEAR(f.gradient[0], e.x, 1e-14);
  EXPECT_NEAR(f.gradient[1], e.y, 1e-14);
  EXPECT_NEAR(f.hessian[Jet<double>::triangle(0, 0)], e.xx, 1e-13);
  EXPECT_NEAR(f.hessian[Jet<double>::triangle(1, 0)], e.xy, 1e-13);
  EXPECT_NEAR(f.hessian[Jet<double>::triangle(1, 1)], e.yy, 1e-13);
  for (int i = 2; i < 9; ++i) EXPECT_EQ(f.gradient[i], 0);
}

const double a = 1.25, b = 0.5;
const Jet<double> x = Jet<double>::variable(a, 0), y = Jet<double>::variable(b, 1);

TEST(Jet, ObeysArithmeticRules) {
  expect_equal(x + y, {a + b, 1, 1, 0, 0, 0});
  expect_equal(x - y, {a - b, 1, -1, 0, 0, 0});
  expect_equal(-x, {-a, -1, 0, 0, 0, 0});
  expect_equal(x * y, {a * b, b, a, 0, 1, 0});
  expect_equal(x * x * y, {a * a * b, 2 * a * b, a * a, 2 * b, 2 * a, 0});
  expect_equal(x / y, {a / b, 1 / b, -a / (b * b), 0, -1 / (b * b), 2 * a / (b * b * b)});
}

TEST(Jet, MixesWithConstants) {
  expect_equal(2.0 * x + 3.0, {2 * a + 3, 2, 0, 0, 0, 0});
  expect_equal(3.0 - x * 2.0, {3 - 2 * a, -2, 0, 0, 0, 0});
  expect_equal(x / 4.0 - 1.0, {a / 4 - 1, 0.25, 0, 0, 0, 0});
  expect_equal(1.0 / x, {1 / a, -1 / (a * a), 0, 2 / (a * a * a), 0, 0});
  expect_equal(Jet<double>(5.0), {5, 0, 0, 0, 0, 0});
  Jet<double> f = x;
  f += y;
  f *= x;
  f -= y;
  expect_equal(f, {(a + b) * a - b, 2 * a + b, a - 1, 2, 1, 0});
}

TEST(Jet, ObeysChainRule) {
  const double p = a * b, root = std::sqrt(p), e = std::exp(p);
  expect_equal(log(x * y), {std::log(p), 1 / a, 1 / b, -1 / (a * a), 0, -1 / (b * b)});
  expect_equal(exp(x * y), {e, b * e, a * e, b * b * e, (1 + p) * e, a * a * e});
  expect_equal(sqrt(x * y), {root, b / (2 * root), a / (2 * root), -b * b / (4 * p * root), 1 / (4 * root),
                             -a * a / (4 * p * root)});
  const double third = std::cbrt(a);
  expect_equal(cbrt(x), {third, third / (3 * a), 0, -2 * third / (9 * a * a), 0, 0});
  expect_equal(pow(x, -2.5), {std::pow(a, -2.5), -2.5 * std::pow(a, -3.5), 0, 8.75 * std::pow(a, -4.5), 0, 0});
}

TEST(Jet, DifferentiatesBranchOfValue) {
  expect_equal(where_positive(x - y, x, y), {a, 1, 0, 0, 0, 0});
  expect_equal(where_positive(y - x, x, y), {b, 0, 1, 0, 0, 0});
}

// d det F / dF = cof F, and the determinant is linear in each entry.
TEST(Jet, DifferentiatesDeterminant) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> entry(-1, 1);
  Mat3d F;
  for (double& f : F.a) f = entry(random);
  const Jet<double> J = determinant(jet_variables(F));
  const Mat3d P = gradient(J), expected = cofactor(F);
  const Mat9d H = hessian(J);
  for (int i = 0; i < 9; ++i) {
    EXPECT_NEAR(P.a[i], expected.a[i], 1e-15);
    EXPECT_EQ(H(i, i), 0);
  }
  EXPECT_NEAR(H(0, 4), F(2, 2), 1e-15);
  EXPECT_NEAR(H(1, 3), -F(2, 2), 1e-15);
}

TEST(Jet, OverPackAgreesWithDoubleInEachLane) {
  const auto f = [](const auto& u, const auto& v) { return log(u * v + 2.0) / (1.0 + sqrt(u)); };
  Pack lanes;
  for (int l = 0; l < kPackWidth; ++l) lanes.set(l, 1 + l);
  const Jet<Pack> together = f(Jet<Pack>::variable(lanes, 0), Jet<Pack>::variable(Pack(b), 1));
  for (int l = 0; l < kPackWidth; ++l) {
    const Jet<double> alone = f(Jet<double>::variable(lanes[l], 0), y);
    EXPECT_NEAR(together.value[l], alone.value, 1e-15);
    for (int i = 0; i < 2; ++i) EXPECT_NEAR(together.gradient[i][l], alone.gradient[i], 1e-15);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(together.hessian[k][l], alone.hessian[k], 1e-15);
  }
}

}  // namespace
}  // namespace aspic::jet_tests
