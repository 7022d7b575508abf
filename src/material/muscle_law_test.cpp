// Derivatives and force-stretch curve of the muscle energy.
#include "material/muscle_law.h"

#include <gtest/gtest.h>

#include "material/states.h"
#include "math/jet.h"

namespace aspic {
namespace {

TEST(MuscleLaw, DerivativesAreThoseOfTheEnergy) {
  std::mt19937 random(4);
  for (const double stretch : {0.3, 0.45, 0.7, 1.0, 1.3, 1.55, 1.9}) {
    const Vec3d a = random_rotation(random) * Vec3d{{1, 0, 0}};
    const MuscleLaw::Params<double> p = {3, 1.1, a[0], a[1], a[2]};
    const MuscleLaw::Params<Jet<double>> jets = {p.tension, p.optimal, p.ax, p.ay, p.az};
    const Mat3d F = stretch * random_rotation(random) * (identity3<double>() + 0.05 * random_matrix(random));
    const Jet<double> exact = MuscleLaw::psi(jet_variables(F), jets);
    EXPECT_NEAR(MuscleLaw::psi(F, p), exact.value, 1e-15);
    EXPECT_LE(largest_difference(MuscleLaw::pk1(F, p).a, gradient(exact).a), 1e-13);
    EXPECT_LE(largest_difference(MuscleLaw::hessian(F, p).a, hessian(exact).a), 1e-12);
  }
}

TEST(MuscleLaw, EnergyIsTheIntegralOfTheForce) {
  const MuscleLaw::Params<double> p = {2, 1.25, 1, 0, 0};
  double energy = 0;
  const int steps = 20000;
  const double h = 2.5 / steps;
  for (int i = 0; i < steps; ++i) {
    const double l = (i + 0.5) * h;  // midpoint rule
    energy += h * MuscleLaw::pk1(diagonal(l, 1, 1), p)(0, 0);
    if (i % 1000 == 999) {
      EXPECT_NEAR(MuscleLaw::psi(diagonal(l + h / 2, 1, 1), p), energy, 1e-6) << l;
    }
  }
  EXPECT_NEAR(MuscleLaw::pk1(diagonal(1.25, 1, 1), p)(0, 0), 2 / 1.25, 1e-15);  // largest at the optimal stretch
}

}  // namespace
}  // namespace aspic
