// Special cases of ogden, yeoh and gent, and ogden near equal stretches.
#include <gtest/gtest.h>

#include "material/states.h"

namespace aspic {
namespace {

constexpr Lame kLame = {1, 10};

Ogden::Params<double> ogden(double alpha, double alpha_2 = -2, double share = 0) {
  MaterialParameters m{kLame, {}};
  m.extra[0] = alpha;
  m.extra[1] = alpha_2;
  m.extra[2] = share;
  return Ogden::params(m);
}

template <class A, class B>
void expect_equal(const typename A::template Params<double>& a, const typename B::template Params<double>& b) {
  for (const auto& [name, F] : smooth_states<Ogden>()) {
    SCOPED_TRACE(name);
    const double stiffness = largest(B::hessian(F, b).a), size = 1 + std::sqrt(squared_norm(F));
    EXPECT_NEAR(A::psi(F, a), B::psi(F, b), 1e-14 * stiffness * size * size);
    EXPECT_LE(largest_difference(A::pk1(F, a).a, B::pk1(F, b).a), 1e-13 * stiffness * size);
    EXPECT_LE(largest_difference(A::hessian(F, a).a, B::hessian(F, b).a), 1e-13 * stiffness);
  }
}

TEST(Ogden, IsNeoHookeanAndMooneyRivlinForExponentsOfTwo) {
  MaterialParameters m{kLame, {}};
  expect_equal<Ogden, NeoHookeanIsochoric>(ogden(2), NeoHookeanIsochoric::params(m));
  m.extra[0] = 0.3;
  expect_equal<Ogden, MooneyRivlin>(ogden(2, -2, 0.3), MooneyRivlin::params(m));
}

// The density in extended precision by its formula; the limit for alpha = 0 is mu |ln s|^2.
long double density(const std::array<long double, 3>& s, long double alpha) {
  const long double J = s[0] * s[1] * s[2], K = kLame.lambda + 2 * kLame.mu / 3.0L;
  long double W = 0;
  for (const long double x : s) {
    const long double e = std::log(x) - std::log(J) / 3;
    W += alpha == 0 ? kLame.mu * e * e : 2 * kLame.mu / (alpha * alpha) * (std::exp(alpha * e) - 1);
  }
  return W + K / 2 * (J - 1) * (J - 1);
}

TEST(Ogden, FollowsItsFormulaForAnyExponent) {
  std::mt19937 random(3);
  for (const double alpha : {-18.7, -3.0, 0.0, 0.5, 25.0})
    for (const std::array<double, 3>& s :
         {std::array{1.3, 0.8, 0.9}, {1.1, 1.0, 1.0}, {0.7, 0.7, 0.7}, {1 + 1e-7, 1.0, 1 - 1e-9}, {4.0, 0.5, 0.4}}) {
      SCOPED_TRACE(alpha);
      const Mat3d F = random_rotation(random) * diagonal(s[0], s[1], s[2]) * random_rotation(random);
      const long double exact = density({s[0], s[1], s[2]}, alpha);
      EXPECT_NEAR(Ogden::psi(F, ogden(alpha)), static_cast<double>(exact), 1e-13 * (1 + static_cast<double>(exact)));
    }
}

// Quotients of differences would lose all digits where two stretches nearly coincide.
TEST(Ogden, HessianIsContinuousAtEqualStretches) {
  for (const double alpha : {-18.7, 0.0, 1.0, 25.0}) {
    const Mat9d at = Ogden::hessian(diagonal(1.2, 0.9, 0.9), ogden(alpha));
    for (const double gap : {1e-15, 1e-12, 1e-9, 1e-7}) {
      const Mat9d near = Ogden::hessian(diagonal(1.2, 0.9, 0.9 + gap), ogden(alpha));
      EXPECT_LE(largest_difference(at.a, near.a), (1e-12 + 100 * gap) * largest(at.a)) << alpha << ' ' << gap;
    }
  }
}

TEST(Ogden, IsInfiniteInInvertedElementsOnly) {
  EXPECT_TRUE(std::isinf(Ogden::psi(diagonal(1, 1, -1), ogden(3))));
  EXPECT_TRUE(std::isinf(Ogden::psi(diagonal(1, 1, 0), ogden(3))));
  EXPECT_TRUE(std::isfinite(Ogden::psi(diagonal(1, 1, 1e-3), ogden(3))));
}

TEST(Yeoh, IsNeoHookeanWithoutHigherTerms) {
  MaterialParameters m{kLame, {}};
  expect_equal<Yeoh, NeoHookeanIsochoric>(Yeoh::params(m), NeoHookeanIsochoric::params(m));
}

TEST(Gent, IsNeoHookeanWithoutLimitAndInfiniteBeyondIt) {
  MaterialParameters m{kLame, {}};
  m.extra[0] = 2;  // I1bar - 3 reaches 2 at a uniaxial stretch of 2.000
  EXPECT_TRUE(std::isfinite(Gent::psi(diagonal(1.99, std::sqrt(1 / 1.99), std::sqrt(1 / 1.99)), Gent::params(m))));
  EXPECT_TRUE(std::isinf(Gent::psi(diagonal(2.01, std::sqrt(1 / 2.01), std::sqrt(1 / 2.01)), Gent::params(m))));
  m.extra[0] = 1e6;
  const Mat3d F = diagonal(1.3, 0.8, 0.9);
  EXPECT_NEAR(Gent::psi(F, Gent::params(m)), NeoHookeanIsochoric::psi(F, NeoHookeanIsochoric::params(m)), 1e-6);
}

}  // namespace
}  // namespace aspic
