#include "scene/expression_function.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "linalg/linear_solver.h"
#include "optimize/minimize.h"
#include "optimize/newton.h"
#include "optimize/test_functions.h"

namespace aspic {
namespace {

// Asserts the accuracy stated in the header on functions with known derivatives.
TEST(ExpressionFunction, DerivativesMatchFormula) {
  const Rosenbrock rosenbrock;
  const TwoBump two_bump;
  const std::pair<ExpressionFunction, const PlanarFunction*> pairs[] = {
      {ExpressionFunction("x * exp(-x^2 - y^2)"), &two_bump},
      {ExpressionFunction("(1 - x)^2 + 100 * (y - x^2)^2"), &rosenbrock}};
  for (const auto& [formula, exact] : pairs) {
    for (const Planar& p : {Planar{-0.8, 0.6}, Planar{0.3, 0.9}, Planar{1, 1}, Planar{0, 0}}) {
      const double size = exact == &two_bump ? 1 : 1000;
      const Planar g = formula.gradient_at(p), g_exact = exact->gradient_at(p);
      for (size_t i = 0; i < 2; ++i) EXPECT_NEAR(g[i], g_exact[i], size * 4e-12);
      const PlanarHessian H = formula.hessian_at(p), H_exact = exact->hessian_at(p);
      EXPECT_NEAR(H.xx, H_exact.xx, size * 2e-9);
      EXPECT_NEAR(H.xy, H_exact.xy, size * 2e-9);
      EXPECT_NEAR(H.yy, H_exact.yy, size * 2e-9);
    }
  }
}

TEST(ExpressionFunction, NewtonFindsItsMinimum) {
  ExpressionFunction f("cosh(x - 1) + 2 * (y + 0.5)^2");
  Newton newton(make_linear_solver("cholesky"));
  std::vector<double> x = {2.5, 1, 0};
  EXPECT_TRUE(is_success(Minimizer().minimize(f, newton, x, {}).status));
  EXPECT_NEAR(x[0], 1, 1e-6);
  EXPECT_NEAR(x[1], -0.5, 1e-6);
}

TEST(ExpressionFunction, IsNotFiniteOutsideItsDomain) {
  const ExpressionFunction f("log(x) + y");
  EXPECT_FALSE(std::isfinite(f.at({-1, 0})));
  EXPECT_TRUE(std::isfinite(f.at({1, 0})));
}

TEST(ExpressionFunction, RejectsThirdCoordinate) {
  for (const char* formula : {"x + z", "Z * x", "x + t"}) EXPECT_THROW(ExpressionFunction{formula}, InvalidInput);
  EXPECT_EQ(ExpressionFunction("X * 10 + Y").at({1, 2}), 12);
}

}  // namespace
}  // namespace aspic
