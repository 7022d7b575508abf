#include "math/definite.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace aspic {
namespace {

using Spectrum = std::array<double, 9>;

// Returns a random orthonormal basis: eigenvectors of a random symmetric matrix.
std::array<double, 81> random_basis(std::mt19937& random) {
  std::normal_distribution<double> normal;
  std::array<double, 81> A{};
  for (int c = 0; c < 9; ++c)
    for (int r = 0; r <= c; ++r) A[r + 9 * c] = A[c + 9 * r] = normal(random);
  return symmetric_eigen<9>(A).vectors;
}

Mat9d with_spectrum(const Spectrum& values, const std::array<double, 81>& Q) {
  Mat9d H{};
  for (int k = 0; k < 9; ++k)
    for (int c = 0; c < 9; ++c)
      for (int r = 0; r < 9; ++r) H(r, c) += values[k] * (Q[r + 9 * k] * Q[c + 9 * k]);
  return H;
}

Spectrum spectrum(const Mat9d& H) {
  std::array<double, 81> A;
  std::copy(H.a, H.a + 81, A.begin());
  Spectrum values = symmetric_eigen<9>(A).values;
  std::sort(values.begin(), values.end());
  return values;
}

TEST(SymmetricEigen, FindsGivenSpectrum) {
  std::mt19937 random(1);
  for (const Spectrum& values : {Spectrum{-4, -1, -1, 0, 0, 0, 2, 2, 9}, Spectrum{1, 1, 1, 1, 1, 1, 1, 1, 1},
                                 Spectrum{-1e6, -1, -1e-6, 0, 1e-9, 1e-3, 1, 1e3, 1e6}}) {
    const Spectrum found = spectrum(with_spectrum(values, random_basis(random)));
    for (int k = 0; k < 9; ++k) EXPECT_NEAR(found[k], values[k], 1e-14 * std::abs(values[8]));
  }
}

TEST(SymmetricEigen, HasOrthonormalVectors) {
  std::mt19937 random(2);
  const auto Q = random_basis(random);
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 9; ++j) {
      double product = 0;
      for (int k = 0; k < 9; ++k) product += Q[k + 9 * i] * Q[k + 9 * j];
      EXPECT_NEAR(product, i == j, 5e-15);
    }
}

TEST(IndefiniteLanes, AcceptsSemidefiniteMatricesAtAnyScale) {
  std::mt19937 random(3);
  for (const double scale : {1e-12, 1.0, 1e12}) {
    for (const Spectrum& values : {Spectrum{1, 1, 1, 1, 1, 1, 1, 1, 1}, Spectrum{0, 0, 0, 0, 0, 0, 0, 0, 0},
                                   Spectrum{0, 0, 0, 1, 2, 3, 4, 5, 6}, Spectrum{0, 0, 0, 0, 0, 0, 0, 0, 1}}) {
      Mat9d H = with_spectrum(values, random_basis(random));
      for (double& h : H.a) h *= scale;
      EXPECT_EQ(indefinite_lanes(H), 0u);
    }
  }
}

TEST(IndefiniteLanes, DetectsNegativeEigenvalueOfOneBillionth) {
  std::mt19937 random(4);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(indefinite_lanes(with_spectrum({-1e-9, 0, 0, 0.1, 1, 1, 1, 1, 1}, random_basis(random))), 1u);
    EXPECT_EQ(indefinite_lanes(with_spectrum({1e-9, 1e-6, 0.1, 0.1, 1, 1, 1, 1, 1}, random_basis(random))), 0u);
  }
}

TEST(IndefiniteLanes, ReportsFailingLanes) {
  std::mt19937 random(5);
  for (unsigned expected = 0; expected < (1u << kPackWidth); expected += 3) {
    Mat9<Pack> H;
    for (int lane = 0; lane < kPackWidth; ++lane) {
      const double lowest = expected >> lane & 1 ? -0.01 : 0.0;
      const Mat9d Hl = with_spectrum({lowest, 1, 2, 3, 4, 5, 6, 7, 8}, random_basis(random));
      for (int i = 0; i < 81; ++i) H.a[i].set(lane, Hl.a[i]);
    }
    EXPECT_EQ(indefinite_lanes(H), expected);
  }
}

TEST(IndefiniteLanes, RejectsNaN) {
  Mat9d H = with_spectrum({1, 1, 1, 1, 1, 1, 1, 1, 1}, {1});
  H(8, 3) = H(3, 8) = std::nan("");
  EXPECT_EQ(indefinite_lanes(H), 1u);
}

TEST(ModifyHessian, ChangesNegativeEigenvaluesOnly) {
  std::mt19937 random(6);
  const Spectrum values = {-5, -2, -1e-3, 0, 1e-3, 1, 2, 3, 10};
  const auto Q = random_basis(random);
  const double floor = 1e-8 * 10;
  for (const EigenvalueFilter filter : {EigenvalueFilter::clamp, EigenvalueFilter::absolute}) {
    Spectrum expected = values;
    for (double& l : expected) l = std::fmax(filter == EigenvalueFilter::clamp ? l : std::abs(l), floor);
    Mat9d H = with_spectrum(values, Q);
    modify_hessian(H, filter, ~0U, 1e-8);
    const Mat9d H_expected = with_spectrum(expected, Q);
    for (int i = 0; i < 81; ++i) EXPECT_NEAR(H.a[i], H_expected.a[i], 1e-13);
    EXPECT_EQ(indefinite_lanes(H), 0u);
  }
}

TEST(ModifyHessian, FiltersFailingLanesAndKeepsOthersBitwise) {
  std::mt19937 random(8);
  Mat9<Pack> before;
  Mat9d alone[kPackWidth];
  for (int lane = 0; lane < kPackWidth; ++lane) {
    const double lowest = lane % 2 == 1 ? -0.5 * lane : 0.0;
    alone[lane] = with_spectrum({lowest, 0, 0, 1, 2, 3, 4, 5, 6}, random_basis(random));
    for (int i = 0; i < 81; ++i) before.a[i].set(lane, alone[lane].a[i]);
  }
  Mat9<Pack> after = before;
  EXPECT_EQ(modify_hessian(after, EigenvalueFilter::clamp), 0xaau & ((1u << kPackWidth) - 1));
  EXPECT_EQ(indefinite_lanes(after), 0u);
  for (int lane = 0; lane < kPackWidth; ++lane) {
    modify_hessian(alone[lane], EigenvalueFilter::clamp);
    for (int i = 0; i < 81; ++i) {
      EXPECT_NEAR(after.a[i][lane], alone[lane].a[i], 1e-13);
      if (lane % 2 == 0) {
        EXPECT_EQ(after.a[i][lane], before.a[i][lane]);
      }
    }
  }
}

TEST(ModifyHessian, KeepsPositiveDefiniteMatricesBitwise) {
  std::mt19937 random(7);
  const Mat9d before = with_spectrum({0.5, 1, 2, 3, 4, 5, 6, 7, 8}, random_basis(random));
  Mat9d after = before;
  modify_hessian(after, EigenvalueFilter::clamp);
  for (int i = 0; i < 81; ++i) EXPECT_EQ(after.a[i], before.a[i]);
}

}  // namespace
}  // namespace aspic
