// Properties of material derivatives other than accuracy, which `verify` checks.
#include <gtest/gtest.h>

#include "material/states.h"

namespace aspic {
namespace {

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

TEST(RotationMaterials, StayFiniteAtRotationJumps) {
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
