// Derivatives and special cases of the laws of heart and muscle.
#include <gtest/gtest.h>

#include "material/fibre_law.h"
#include "material/guccione_law.h"
#include "material/hill_law.h"
#include "material/material.h"
#include "material/states.h"
#include "material/tension_law.h"
#include "material/weiss_law.h"
#include "math/jet.h"

namespace aspic {
namespace {

Vec3d axis_of_laws(std::mt19937& random) { return random_rotation(random) * Vec3d{{1, 0, 0}}; }

// Deformations with stretches from 0.5 to 2 along a.
std::vector<Mat3d> stretched_states(const Vec3d& a, std::mt19937& random) {
  std::vector<Mat3d> all;
  for (const double stretch : {0.5, 0.8, 0.99, 1.01, 1.03, 1.06, 1.2, 2.0})
    all.push_back(random_rotation(random) * (identity3<double>() + (stretch - 1) * outer(a, a)));
  for (int i = 0; i < 10; ++i) all.push_back(random_deformation(random));
  return all;
}

template <class Law>
void expect_derivatives(const typename Law::template Params<double>& p, std::mt19937& random) {
  for (const Mat3d& F : stretched_states({{p.ax, p.ay, p.az}}, random)) {
    const Jet<double> exact = Law::psi(jet_variables(F), broadcast_params<Law, Jet<double>>(p));
    const double scale = 1 + std::abs(exact.value);
    EXPECT_NEAR(Law::psi(F, p), exact.value, 1e-12 * scale);
    EXPECT_LE(largest_difference(Law::pk1(F, p).a, gradient(exact).a), 1e-11 * (scale + largest(gradient(exact).a)));
    EXPECT_LE(largest_difference(Law::hessian(F, p).a, hessian(exact).a), 1e-11 * (scale + largest(hessian(exact).a)));
  }
}

TEST(GuccioneLaw, DerivativesAreThoseOfTheEnergy) {
  std::mt19937 random(1);
  const Vec3d a = axis_of_laws(random);
  expect_derivatives<GuccioneLaw>({2, 4, 1, 2, a[0], a[1], a[2]}, random);
  expect_derivatives<GuccioneLaw>({2, 0.3, 0.7, 0.2, a[0], a[1], a[2]}, random);
}

// Q = bf Eaa^2 + bt (...) + 2 bfs (...) in the frame of the fibres.
TEST(GuccioneLaw, HasTheExponentOfTheSource) {
  std::mt19937 random(2);
  for (int i = 0; i < 10; ++i) {
    const Mat3d R = random_rotation(random), F = random_deformation(random);
    const Mat3d E = 0.5 * (transpose(R) * (transpose(F) * F - identity3<double>()) * R);  // fibres along R e1
    const auto sq = [&](int r, int c) { return E(r, c) * E(r, c); };
    const double Q = 4 * sq(0, 0) + 1.5 * (sq(1, 1) + sq(2, 2) + 2 * sq(1, 2)) + 2 * 2.5 * (sq(0, 1) + sq(0, 2));
    const double psi = GuccioneLaw::psi(F, {3, 4, 1.5, 2.5, R(0, 0), R(1, 0), R(2, 0)});
    EXPECT_NEAR(psi, 1.5 * (std::exp(Q) - 1), 1e-13 * (1 + psi));
  }
}

TEST(GuccioneLaw, IsIsotropicForEqualConstants) {
  std::mt19937 random(3);
  for (int i = 0; i < 20; ++i) {
    const Mat3d F = random_deformation(random);
    const auto psi = [&](const Mat3d& at) {
      const Vec3d a = axis_of_laws(random);
      return GuccioneLaw::psi(at, {2, 3, 3, 3, a[0], a[1], a[2]});
    };
    EXPECT_NEAR(psi(F * random_rotation(random)), psi(F), 1e-12 * psi(F));
  }
}

TEST(TensionLaw, DerivativesAreThoseOfTheEnergy) {
  std::mt19937 random(4);
  const Vec3d a = axis_of_laws(random);
  expect_derivatives<TensionLaw>({3, a[0], a[1], a[2]}, random);
}

TEST(WeissLaw, DerivativesAreThoseOfTheEnergy) {
  std::mt19937 random(5);
  const Vec3d a = axis_of_laws(random);
  expect_derivatives<WeissLaw>({2, 40, 1.05, 500, a[0], a[1], a[2]}, random);
  expect_derivatives<WeissLaw>({0.5, 5, 3, 7, a[0], a[1], a[2]}, random);
}

TEST(WeissLaw, StressIsThatOfTheSource) {
  const WeissLaw::Params<double> p = {2, 40, 1.05, 500, 1, 0, 0};
  const auto slope = [&](double l) { return WeissLaw::pk1(diagonal(l, 1.1, 0.9), p)(0, 0); };
  EXPECT_EQ(slope(0.9), 0);
  EXPECT_NEAR(slope(1.03), 2 * (std::exp(40 * 0.03) - 1) / 1.03, 1e-13);
  EXPECT_NEAR(slope(1.2) * 1.2 - slope(1.1) * 1.1, 500 * 0.1, 1e-10);
  EXPECT_NEAR(slope(1.05 + 1e-9), slope(1.05 - 1e-9), 1e-5);
}

TEST(HillLaw, DerivativesAreThoseOfTheEnergy) {
  std::mt19937 random(6);
  const Vec3d a = axis_of_laws(random);
  for (const double start : {0.9, 1.3, 3.0})
    expect_derivatives<HillLaw>({2, 3, start, 0.25, 1.5, a[0], a[1], a[2]}, random);
}

TEST(HillLaw, ForceIsHillsHyperbola) {
  const double k = 0.25, rate = 3;
  const HillLaw::Params<double> p = {2, rate, 1, k, 1.5, 1, 0, 0};
  for (const double v : {0.1, 0.5, 0.9}) {  // of shortening
    const double force = 1 + HillLaw::pk1(diagonal(1 - v / rate, 1, 1), p)(0, 0) / 2;
    EXPECT_NEAR((force + k) * (v + k), (1 + k) * k, 1e-14);
  }
  EXPECT_EQ(HillLaw::pk1(diagonal(1 - 1.2 / rate, 1, 1), p)(0, 0), -2);
  EXPECT_NEAR(HillLaw::pk1(diagonal(1e6, 1, 1), p)(0, 0), 2 * 0.5, 1e-6);
}

}  // namespace
}  // namespace aspic
