#include "math/svd3.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "math/eigen3.h"
#include "math/polar3.h"

namespace aspic {
namespace {

constexpr double kRoundOff = 4e-15;  // about 20 roundings

double largest(const Mat3d& A) {
  double most = 0;
  for (const double a : A.a) most = std::fmax(most, std::abs(a));
  return most;
}

Mat3d diagonal(const Vec3d& d) { return {{d[0], 0, 0, 0, d[1], 0, 0, 0, d[2]}}; }

Mat3d random_matrix(std::mt19937& random) {
  std::uniform_real_distribution<double> entry(-1, 1);
  Mat3d A;
  for (double& a : A.a) a = entry(random);
  return A;
}

void expect_rotation(const Mat3d& R) {
  EXPECT_LE(largest(transpose(R) * R - identity3<double>()), kRoundOff);
  EXPECT_NEAR(determinant(R), 1, kRoundOff);
}

void expect_decomposition(const Mat3d& F) {
  const Svd3<double> f = svd3(F);
  expect_rotation(f.U);
  expect_rotation(f.V);
  EXPECT_GE(f.s[0], f.s[1]);
  EXPECT_GE(f.s[1], (1 - kRoundOff) * std::abs(f.s[2]));
  EXPECT_LE(largest(f.U * diagonal(f.s) * transpose(f.V) - F), kRoundOff * largest(F));
}

std::vector<Mat3d> difficult_matrices() {
  std::mt19937 random(2);
  const Mat3d I = identity3<double>(), Z = 0.0 * I;
  std::vector<Mat3d> all = {I, Z, -1.0 * I, diagonal({{1, 1, -1}}), diagonal({{0, 0, 3}}), diagonal({{0, -2, 2}})};
  all.push_back(diagonal({{1e-12, 1, 1e12}}));
  all.push_back({{1, 2, 3, 2, 4, 6, -1, -2, -3}});             // rank 1
  all.push_back({{1, 2, 3, 0, 1, 1, 1, 3, 4}});                // rank 2
  all.push_back({{1, 1e-9, 0, 1, 0, 1e-9, 1, 1e-9, 1e-9}});    // nearly rank 1
  all.push_back({{1, 1, 0, -1, 1, 0, 0, 0, std::sqrt(2.0)}});  // a multiple of a rotation
  for (int i = 0; i < 200; ++i) all.push_back(random_matrix(random));
  for (const double scale : {1e-300, 1e-160, 1e-6, 1e6, 1e150, 1e300}) all.push_back(scale * random_matrix(random));
  return all;
}

TEST(Svd3, ReconstructsMatrixFromProperRotations) {
  for (const Mat3d& F : difficult_matrices()) expect_decomposition(F);
}

TEST(Svd3, LastSingularValueHasSignOfDeterminant) {
  for (const Mat3d& F : difficult_matrices())
    if (std::abs(determinant(F)) > 1e-12 * std::pow(largest(F), 3)) {
      EXPECT_EQ(std::signbit(svd3(F).s[2]), std::signbit(determinant(F)));
    }
}

TEST(Svd3, IsRelativelyAccurateForScaledColumns) {
  std::mt19937 random(4);
  const Mat3d A = random_matrix(random);
  const Mat3d F = A * diagonal({{1, 1e-8, 1e-16}});
  const Svd3<double> f = svd3(F);
  EXPECT_NEAR(f.s[0] * f.s[1] * f.s[2] / (1e-24 * determinant(A)), 1, 1e-13);
}

TEST(Svd3, OverPackAgreesWithDoubleInEachLane) {
  std::mt19937 random(6);
  Mat3d alone[kPackWidth];
  Mat3<Pack> together;
  for (int l = 0; l < kPackWidth; ++l) {
    alone[l] = random_matrix(random);
    for (int i = 0; i < 9; ++i) together.a[i].set(l, alone[l].a[i]);
  }
  const Svd3<Pack> f = svd3(together);
  for (int l = 0; l < kPackWidth; ++l) {
    const Svd3<double> g = svd3(alone[l]);
    for (int i = 0; i < 9; ++i) EXPECT_NEAR(f.U.a[i][l], g.U.a[i], 1e-13);
    for (int i = 0; i < 9; ++i) EXPECT_NEAR(f.V.a[i][l], g.V.a[i], 1e-13);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(f.s[i][l], g.s[i], kRoundOff);
  }
}

TEST(Polar3, RotationIsIdentityForPositiveDefiniteMatrices) {
  const Mat3d S = {{2, 0.5, -0.25, 0.5, 1, 0.125, -0.25, 0.125, 1.5}};
  EXPECT_LE(largest(rotation(svd3(S)) - identity3<double>()), kRoundOff);
}

TEST(Polar3, RotationGradientMatchesDifferences) {
  std::mt19937 random(8);
  for (int k = 0; k < 20; ++k) {
    const Mat3d F = identity3<double>() + 0.4 * random_matrix(random), D = random_matrix(random);
    Mat9d G{};
    add_rotation_gradient(svd3(F), 1.0, 1e-8, G);
    const double h = 1e-5;
    const Mat3d dR = (1 / (2 * h)) * (rotation(svd3(F + h * D)) - rotation(svd3(F - h * D)));
    for (int r = 0; r < 9; ++r) {
      double GD = 0;
      for (int c = 0; c < 9; ++c) GD += G(r, c) * D.a[c];
      EXPECT_NEAR(GD, dR.a[r], 1e-8);  // error: h^2 times third derivatives of order 10
    }
  }
}

// dtr S / dF = R.
TEST(Polar3, StretchTraceHasRotationAsGradient) {
  std::mt19937 random(8);
  for (int k = 0; k < 20; ++k) {
    const Mat3d F = identity3<double>() + 0.4 * random_matrix(random);
    const Jet<double> t = stretch_trace(jet_variables(F));
    EXPECT_LE(largest(gradient(t) - rotation(svd3(F))), 1e-13);
    Mat9d G{};
    add_rotation_gradient(svd3(F), 1.0, 1e-8, G);
    const Mat9d H = hessian(t);
    for (int i = 0; i < 81; ++i) EXPECT_NEAR(H.a[i], G.a[i], 1e-12);
  }
}

TEST(SymmetricEigen3, ReconstructsMatrix) {
  for (const Mat3d& F : difficult_matrices()) {
    const double scale = largest(F);
    if (scale > 1e100) continue;
    const Mat3d A = 0.5 * (F + transpose(F));
    const Eigen3 e = symmetric_eigen(A);
    EXPECT_LE(e.values[0], e.values[1]);
    EXPECT_LE(e.values[1], e.values[2]);
    EXPECT_LE(largest(transpose(e.vectors) * e.vectors - identity3<double>()), kRoundOff);
    EXPECT_LE(largest(e.vectors * diagonal(e.values) * transpose(e.vectors) - A), kRoundOff * scale);
  }
}

}  // namespace
}  // namespace aspic
