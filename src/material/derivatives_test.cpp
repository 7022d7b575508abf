// Stress and Hessian of every material against automatic differentiation of psi and against central differences.
#include <gtest/gtest.h>

#include "material/states_test.h"
#include "math/jet.h"

namespace aspic {
namespace {

template <class M>
Jet<double> psi_jet(const Mat3d& F, const typename M::template Params<double>& p) {
  return M::psi(jet_variables(F), broadcast_params<M, Jet<double>>(p));
}

TEST(MaterialDerivatives, AgreeWithAutomaticDifferentiation) {
  for_each_material([]<class M>() {
    const auto p = ordinary_params<M>();
    for (const auto& [name, F] : smooth_states<M>()) {
      SCOPED_TRACE(M::info().name + " at " + name);
      const Jet<double> expected = psi_jet<M>(F, p);
      const Mat9d H = M::hessian(F, p), H_expected = hessian(expected);
      const double stiffness = largest(H_expected.a), size = 1 + std::sqrt(squared_norm(F));
      ASSERT_TRUE(std::isfinite(stiffness));
      EXPECT_LE(std::abs(M::psi(F, p) - expected.value), 1e-12 * (stiffness * size * size));
      EXPECT_LE(largest_difference(M::pk1(F, p).a, gradient(expected).a), 1e-12 * stiffness * size);
      EXPECT_LE(largest_difference(H.a, H_expected.a), 1e-12 * stiffness);
    }
  });
}

TEST(MaterialDerivatives, HessianIsSymmetric) {
  for_each_material([]<class M>() {
    const auto p = ordinary_params<M>();
    for (const auto& [name, F] : smooth_states<M>()) {
      SCOPED_TRACE(M::info().name + " at " + name);
      const Mat9d H = M::hessian(F, p);
      double asymmetry = 0;
      for (int c = 0; c < 9; ++c)
        for (int r = 0; r < c; ++r) asymmetry = std::fmax(asymmetry, std::abs(H(r, c) - H(c, r)));
      EXPECT_LE(asymmetry, 1e-14 * largest(H.a));
    }
  });
}

// Errors of a central difference with steps 1e-2, 10^-2.5, 1e-3, 10^-3.5; each must be a tenth of the one before
// until it meets round-off, about 1e-16 / h of the value.
template <class Error>
void expect_slope_two(Error error, double scale) {
  double before = 0;
  for (const double h : {1e-2, std::sqrt(1e-5), 1e-3, std::sqrt(1e-7)}) {
    const double now = error(h), round_off = 1e-14 / h * scale;
    ASSERT_TRUE(std::isfinite(now));
    if (before > 0 && now > 10 * round_off) {
      EXPECT_NEAR(std::log10(before / now), 1, 0.05) << "h = " << h;
    }
    EXPECT_LE(now, 100 * h * scale);
    before = now > round_off ? now : 0;
  }
}

// Whether a third derivative jumps on the way from F to G: a spline's, at its knots.
template <class M>
bool passes_knot(const Mat3d& F, const Mat3d& G) {
  if constexpr (std::is_same_v<M, Spline>) {
    const auto bars = [](const Mat3d& A) {
      const double s = isochoric_scale(determinant(A)), I2bar = s * s * squared_norm(cofactor(A));
      return std::pair(s * squared_norm(A) - 3, I2bar * std::sqrt(I2bar) - std::sqrt(27.0));
    };
    const auto [x0, y0] = bars(F);
    const auto [x1, y1] = bars(G);
    for (const double t : SplineLaw::kStretchSpline.knots)
      if ((x0 < t) != (x1 < t)) return true;
    for (const double t : SplineLaw::kAreaSpline.knots)
      if ((y0 < t) != (y1 < t)) return true;
  }
  return false;
}

TEST(MaterialDerivatives, CentralDifferencesConvergeWithSlopeTwo) {
  for_each_material([]<class M>() {
    const auto p = ordinary_params<M>();
    std::mt19937 random(11);
    for (int i = 0; i < 10; ++i) {
      SCOPED_TRACE(M::info().name + " at random " + std::to_string(i));
      Mat3d F, D;
      do {
        F = random_deformation(random), D = random_matrix(random);
      } while (passes_knot<M>(F - 0.01 * D, F + 0.01 * D));
      const Mat3d P = M::pk1(F, p);
      const Mat9d H = M::hessian(F, p);
      Mat3d HD{};
      for (int c = 0; c < 9; ++c)
        for (int r = 0; r < 9; ++r) HD.a[r] += H(r, c) * D.a[c];
      const auto gradient_error = [&](double h) {
        return std::abs((M::psi(F + h * D, p) - M::psi(F - h * D, p)) / (2 * h) - inner(P, D));
      };
      const auto hessian_error = [&](double h) {
        const Mat3d difference = (1 / (2 * h)) * (M::pk1(F + h * D, p) - M::pk1(F - h * D, p));
        return largest_difference(difference.a, HD.a);
      };
      expect_slope_two(gradient_error, largest(H.a));
      expect_slope_two(hessian_error, largest(H.a));
    }
  });
}

TEST(RotationMaterials, StayFiniteWhereTheRotationJumps) {
  const auto check = []<class M>() {
    const auto p = ordinary_params<M>();
    std::mt19937 random(5);
    const Mat3d R = random_rotation(random);
    for (const Mat3d& F : {diagonal(0, 0, 0), diagonal(1, 1, -1), R * diagonal(2, 0, 0), R * diagonal(-1, -1, -1),
                           R * diagonal(3, 1e-9, -1e-9), 1e6 * diagonal(1, 1, -1), 1e-300 * R}) {
      EXPECT_TRUE(std::isfinite(M::psi(F, p)));
      EXPECT_TRUE(std::isfinite(largest(M::pk1(F, p).a)));
      EXPECT_TRUE(std::isfinite(largest(M::hessian(F, p).a)));
    }
  };
  check.operator()<Arap>();
  check.operator()<Corotated>();
}

}  // namespace
}  // namespace aspic
