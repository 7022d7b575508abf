#include "material/law_eigen.h"

#include <gtest/gtest.h>

#include "material/states.h"

namespace aspic {
namespace {

template <class M>
void expect_eigen_to_make_up_the_hessian(const NamedState& state) {
  const std::string what = M::info().name + ", " + state.name;
  const auto p = ordinary_params<M>();
  const Mat9d H = M::hessian(state.F, p);
  const SymmetricEigen<9, double> e = law_eigen(state.F, M::law_derivatives(state.F, p));
  Mat9d sum, products;
  for (int c = 0; c < 9; ++c)
    for (int r = 0; r < 9; ++r) {
      sum(r, c) = products(r, c) = 0;
      for (int k = 0; k < 9; ++k) {
        sum(r, c) += e.values[k] * e.vectors[9 * k + r] * e.vectors[9 * k + c];
        products(r, c) += e.vectors[9 * r + k] * e.vectors[9 * c + k];
      }
      EXPECT_NEAR(products(r, c), r == c, 1e-14) << what;
    }
  EXPECT_LE(largest_difference(sum.a, H.a), 1e-13 * largest(H.a)) << what;
}

TEST(LawEigen, EigenpairsReproduceHessians) {
  for_each_material([]<class M>() {
    if constexpr (requires { typename M::Law; })
      for (const NamedState& state : smooth_states<M>()) expect_eigen_to_make_up_the_hessian<M>(state);
  });
}

}  // namespace
}  // namespace aspic
