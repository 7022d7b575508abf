// Polyconvexity, small strain and continuity of the spline material, for random coefficients.
#include "material/spline.h"

#include <gtest/gtest.h>

#include "material/states.h"

namespace aspic {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

MaterialParameters random_spline(std::mt19937& random, double young = 1, double poisson = 0.4) {
  std::uniform_real_distribution<double> unit(0, 1);
  MaterialParameters m{lame_from_young_poisson(young, poisson), {}};
  for (int k = 0; k < 2; ++k) m.extra[k] = unit(random);
  for (int k = 2; k < kMaxExtraParameters; ++k)  // some are zero, others up to 100
    m.extra[k] = unit(random) < 0.5 ? 0 : std::pow(10, 4 * unit(random) - 2);
  return m;
}

// Returns stretches over a few powers of ten, J > 0.
Mat3d strong_deformation(std::mt19937& random) {
  std::normal_distribution<double> exponent(0, 0.7);
  return random_rotation(random) *
         diagonal(std::exp(exponent(random)), std::exp(exponent(random)), std::exp(exponent(random))) *
         random_rotation(random);
}

TEST(ConvexSpline, HasSlopesOfItsCoefficients) {
  const auto& spline = SplineLaw::kStretchSpline;
  for (std::size_t i = 0; i < SplineLaw::kGrowths; ++i) {
    double c[SplineLaw::kGrowths] = {};
    c[i] = 2.5;
    EXPECT_EQ(spline(spline.knots[i], c).slope, 0);
    EXPECT_NEAR(spline(spline.knots[i + 2], c).slope, 2.5, 1e-15 * 2.5);
    EXPECT_NEAR(spline(1e9, c).slope, 2.5, 1e-15 * 2.5);
    EXPECT_EQ(spline(1e9, c).curvature, 0);
    EXPECT_EQ(spline(-1.0, c).value, 0);
    EXPECT_NEAR(spline(spline.knots[i + 1], c).curvature, 5 / (spline.knots[i + 2] - spline.knots[i]), 1e-12);
  }
}

TEST(ConvexSpline, HasContinuousConsistentDerivatives) {
  const auto& spline = SplineLaw::kStretchSpline;
  const double c[SplineLaw::kGrowths] = {0.3, 1, 0, 2, 0.5, 4, 0.1, 0.7};
  for (const double knot : spline.knots)
    for (const double x : {knot - 1e-9, knot, knot + 1e-9, 0.6 * knot + 0.01}) {
      const double h = 1e-5 * std::fmax(x, 0.01);
      EXPECT_NEAR((spline(x + h, c).value - spline(x - h, c).value) / (2 * h), spline(x, c).slope, 1e-7) << x;
      EXPECT_NEAR((spline(x + h, c).slope - spline(x - h, c).slope) / (2 * h), spline(x, c).curvature, 1e-3) << x;
    }
}

TEST(Spline, IsIsochoricNeoHookeanWithoutCoefficients) {
  std::mt19937 random(1);
  const MaterialParameters m{lame_from_young_poisson(2, 0.4), {}};
  for (int i = 0; i < 20; ++i) {
    const Mat3d F = random_deformation(random);
    const double expected = NeoHookeanIsochoric::psi(F, NeoHookeanIsochoric::params(m));
    EXPECT_NEAR(Spline::psi(F, Spline::params(m)), expected, 1e-14);
  }
}

TEST(Spline, HasSmallStrainModuliForAnyCoefficients) {
  std::mt19937 random(2);
  for (int i = 0; i < 50; ++i)
    for (const double poisson : {-0.3, 0.0, 0.3, 0.499}) {
      const MaterialParameters m = random_spline(random, 3, poisson);
      const Mat9d expected = Linear::hessian(identity3<double>(), Linear::params(m));
      const Mat9d H = Spline::hessian(identity3<double>(), Spline::params(m));
      EXPECT_LE(largest_difference(H.a, expected.a), 1e-14 * largest(expected.a));
    }
}

TEST(Spline, AgreesWithAutomaticDifferentiationForAnyCoefficients) {
  std::mt19937 random(3);
  for (int i = 0; i < 300; ++i) {
    const auto p = Spline::params(random_spline(random));
    const Mat3d F = strong_deformation(random);
    const Jet<double> expected = Spline::psi(jet_variables(F), broadcast_params<Spline, Jet<double>>(p));
    const Mat9d H = Spline::hessian(F, p);
    const double stiffness = largest(H.a), size = 1 + std::sqrt(squared_norm(F));
    EXPECT_LE(largest_difference(Spline::pk1(F, p).a, gradient(expected).a), 1e-12 * stiffness * size);
    EXPECT_LE(largest_difference(H.a, hessian(expected).a), 1e-12 * stiffness);
  }
}

double rank_one_curvature(const Mat9d& H, const Vec3d& a, const Vec3d& b) {
  double sum = 0;
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 9; ++j) sum += a[i % 3] * b[i / 3] * H(i, j) * a[j % 3] * b[j / 3];
  return sum;
}

Vec3d random_direction(std::mt19937& random) {
  const Mat3d R = random_rotation(random);
  return {{R(0, 0), R(1, 0), R(2, 0)}};
}

TEST(Spline, IsElliptic) {
  std::mt19937 random(4);
  for (int i = 0; i < 2000; ++i) {
    const auto p = Spline::params(random_spline(random, 1, 0.45));
    const Mat9d H = Spline::hessian(strong_deformation(random), p);
    for (int k = 0; k < 10; ++k)
      EXPECT_GE(rank_one_curvature(H, random_direction(random), random_direction(random)), -1e-12 * largest(H.a));
  }
}

// Shows that the test above can fail: I2bar is not polyconvex, and Mooney-Rivlin is not elliptic.
TEST(Spline, IsEllipticWhereMooneyRivlinIsNot) {
  std::mt19937 random(4);
  MaterialParameters m{lame_from_shear_bulk(1, 1e-3), {1}};
  double least_spline = kInf, least_mooney = kInf;
  for (int i = 0; i < 2000; ++i) {
    const Mat3d F = strong_deformation(random);
    const Vec3d a = random_direction(random), b = random_direction(random);
    const Mat9d spline = Spline::hessian(F, Spline::params(m)),
                mooney = MooneyRivlin::hessian(F, MooneyRivlin::params(m));
    least_spline = std::fmin(least_spline, rank_one_curvature(spline, a, b) / largest(spline.a));
    least_mooney = std::fmin(least_mooney, rank_one_curvature(mooney, a, b) / largest(mooney.a));
  }
  EXPECT_GE(least_spline, -1e-12);
  EXPECT_LT(least_mooney, -1e-3);
}

TEST(Spline, IsConvexInMinors) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> exponent(-1, 1), size(0, 3);
  // Lines through states whose isochoric invariants may also be below 3, to which W is extended.
  for (int i = 0; i < 20000; ++i) {
    const auto p = Spline::params(random_spline(random));
    const Mat3d F0 = size(random) * random_matrix(random), F1 = size(random) * random_matrix(random);
    const Mat3d A0 = size(random) * random_matrix(random), A1 = size(random) * random_matrix(random);
    const double J0 = std::exp(exponent(random)), J1 = std::exp(exponent(random));
    const double ends = 0.5 * (Spline::of_minors(F0, A0, J0, p) + Spline::of_minors(F1, A1, J1, p));
    const double middle = Spline::of_minors(0.5 * (F0 + F1), 0.5 * (A0 + A1), 0.5 * (J0 + J1), p);
    EXPECT_LE(middle, ends + 1e-12 * (std::abs(ends) + 1));
  }
}

TEST(Spline, StaysFiniteFarBeyondLastKnot) {
  std::mt19937 random(6);
  for (int i = 0; i < 100; ++i) {
    const auto p = Spline::params(random_spline(random));
    for (const Mat3d& F : {diagonal(1e3, 1e-2, 1), diagonal(1e6, 1e-6, 1e-6), diagonal(1, 1, 1e-9)}) {
      EXPECT_TRUE(std::isfinite(Spline::psi(F, p)));
      EXPECT_TRUE(std::isfinite(largest(Spline::hessian(F, p).a)));
    }
  }
}

}  // namespace
}  // namespace aspic
