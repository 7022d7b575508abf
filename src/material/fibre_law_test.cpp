// Derivatives, convexity and special cases of the fibre energy.
#include "material/fibre_law.h"

#include <gtest/gtest.h>

#include <cmath>

#include "material/states.h"
#include "math/jet.h"
#include "math/symmetric_eigen.h"

namespace aspic {
namespace {

FibreLaw::Params<double> along(const Vec3d& a, double kappa, double k2 = 0.8) {
  return {3, k2, kappa, a[0], a[1], a[2]};
}

Vec3d random_axis(std::mt19937& random) { return random_rotation(random) * Vec3d{{1, 0, 0}}; }

// Returns deformations with slack, straightening and taut fibres along a.
std::vector<Mat3d> stretches_along(const Vec3d& a, std::mt19937& random) {
  std::vector<Mat3d> all;
  for (const double stretch : {0.7, 1 - 1e-9, 1 + 1e-9, 1.002, 1.0045, 1.2, 1.6})
    all.push_back(random_rotation(random) * (identity3<double>() + (stretch - 1) * outer(a, a)));
  for (int i = 0; i < 10; ++i) all.push_back(random_deformation(random));
  return all;
}

TEST(FibreLaw, DerivativesAreThoseOfTheEnergy) {
  std::mt19937 random(1);
  for (const double kappa : {0.0, 0.1, 1.0 / 3}) {
    const Vec3d a = random_axis(random);
    const auto p = along(a, kappa);
    for (const Mat3d& F : stretches_along(a, random)) {
      const FibreLaw::Params<Jet<double>> jets = {p.k1, p.k2, p.kappa, p.ax, p.ay, p.az};
      const Jet<double> exact = FibreLaw::psi(jet_variables(F), jets);
      EXPECT_NEAR(FibreLaw::psi(F, p), exact.value, 1e-14 * std::abs(exact.value));
      EXPECT_LE(largest_difference(FibreLaw::pk1(F, p).a, gradient(exact).a), 1e-13 * p.k1);
      EXPECT_LE(largest_difference(FibreLaw::hessian(F, p).a, hessian(exact).a), 1e-12 * p.k1);
    }
  }
}

TEST(FibreLaw, HessiansArePositiveSemidefinite) {
  std::mt19937 random(2);
  for (const double kappa : {0.0, 0.2, 1.0 / 3})
    for (int i = 0; i < 20; ++i) {
      const Mat9d A = FibreLaw::hessian(1.3 * random_deformation(random), along(random_axis(random), kappa));
      std::array<double, 81> entries;
      std::copy(A.a, A.a + 81, entries.begin());
      const SymmetricEigen<9, double> eigen = symmetric_eigen<9>(entries);
      for (const double value : eigen.values) EXPECT_GE(value, -1e-13 * largest(A.a));
    }
}

TEST(FibreLaw, IsIsotropicForDispersionOfOneThird) {
  std::mt19937 random(3);
  for (int i = 0; i < 20; ++i) {
    const Mat3d F = 1.2 * random_deformation(random);
    const double psi = FibreLaw::psi(F, along(random_axis(random), 1.0 / 3));
    EXPECT_NEAR(FibreLaw::psi(F, along(random_axis(random), 1.0 / 3)), psi, 1e-12 * psi);
    EXPECT_NEAR(FibreLaw::psi(F * random_rotation(random), along(random_axis(random), 1.0 / 3)), psi, 1e-12 * psi);
  }
}

// Uniaxial tension of an incompressible body along the fibres, by the formula of [Gasser 2006] for the mean direction.
TEST(FibreLaw, FollowsTheExponentialInTensionAndIsSlackInCompression) {
  const double k1 = 3;
  for (const double k2 : {0.8, 20.0})
    for (const double kappa : {0.0, 0.1, 0.226, 0.3}) {
      const auto p = along({{1, 0, 0}}, kappa, k2);
      for (const double l : {1.02, 1.05, 1.3, 1.5}) {
        const double across = 1 / std::sqrt(l), E = kappa * (l * l + 2 / l) + (1 - 3 * kappa) * l * l - 1;
        if (E < FibreLaw::kEps) continue;
        const double slope = k1 * E * std::exp(k2 * E * E);
        const Mat3d P = FibreLaw::pk1(diagonal(l, across, across), p);
        EXPECT_NEAR(P(0, 0), 2 * slope * (1 - 2 * kappa) * l, 1e-12 * (1 + slope)) << l << " " << kappa;
        EXPECT_NEAR(P(1, 1), 2 * slope * kappa * across, 1e-12 * (1 + slope)) << l << " " << kappa;
      }
    }
  EXPECT_EQ(largest(FibreLaw::pk1(diagonal(0.9, 1.5, 1.5), along({{1, 0, 0}}, 0)).a), 0);
}

}  // namespace
}  // namespace aspic
