#include "math/eigen2.h"

#include <gtest/gtest.h>

#include <cmath>

namespace aspic {
namespace {

TEST(Eigen2, DecomposesSymmetricMatrices) {
  for (const Sym2& A : {Sym2{2, 1, 0.5}, Sym2{1, 2, 0.5}, Sym2{-1, 3, -4}, Sym2{1, 1, 1e-9}, Sym2{5, 2, 0},
                        Sym2{2, 5, 0}, Sym2{0, 0, 0}, Sym2{0, 0, -2}}) {
    const Eigen2 e = symmetric_eigen(A);
    EXPECT_GE(e.high, e.low);
    EXPECT_NEAR(e.cos * e.cos + e.sin * e.sin, 1, 1e-15);
    EXPECT_NEAR(e.high * e.low, A.xx * A.yy - A.xy * A.xy, 1e-14);
    const Sym2 B = from_eigen(e);
    EXPECT_NEAR(B.xx, A.xx, 1e-14);
    EXPECT_NEAR(B.yy, A.yy, 1e-14);
    EXPECT_NEAR(B.xy, A.xy, 1e-14);
  }
}

}  // namespace
}  // namespace aspic
