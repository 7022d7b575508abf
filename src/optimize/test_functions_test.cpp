#include "optimize/test_functions.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "linalg/linear_solver.h"
#include "optimize/gradient_descent.h"
#include "optimize/minimize.h"
#include "optimize/newton.h"

namespace aspic {
namespace {

MinimizeOptions long_and_tight() {
  MinimizeOptions options;
  options.tolerance = 1e-10;
  options.max_iterations = 200;
  return options;
}

TEST(TestFunctions, MinimaAreCorrect) {
  for (const TestFunction& info : test_functions()) {
    const auto f = make_test_function(info.name);
    EXPECT_NEAR(f->at(info.minimizer), info.minimum, 1e-15) << info.name;
    const Planar g = f->gradient_at(info.minimizer);
    EXPECT_NEAR(std::hypot(g[0], g[1]), 0, 1e-15) << info.name;
    const PlanarHessian H = f->hessian_at(info.minimizer);
    EXPECT_GT(H.xx + H.yy, 0) << info.name;
    EXPECT_GT(H.xx * H.yy - H.xy * H.xy, 0) << info.name;
  }
}

TEST(TestFunctions, NewtonFindsEachMinimum) {
  for (const TestFunction& info : test_functions()) {
    const auto f = make_test_function(info.name);
    Newton newton(make_linear_solver("cholesky"));
    std::vector<double> x = {info.start[0], info.start[1], 0};
    const MinimizeReport report = Minimizer().minimize(*f, newton, x, long_and_tight());
    EXPECT_TRUE(is_success(report.status)) << info.name << ": " << to_string(report.status);
    EXPECT_NEAR(x[0], info.minimizer[0], 1e-9) << info.name;
    EXPECT_NEAR(x[1], info.minimizer[1], 1e-9) << info.name;
  }
}

TEST(TestFunctions, NewtonNeedsOneIterationOnQuadratic) {
  Quadratic f(1e4, 1.1);
  Newton newton(make_linear_solver("cholesky"));
  std::vector<double> x = {1.2, 0.9, 0};
  EXPECT_EQ(Minimizer().minimize(f, newton, x, long_and_tight()).iterations, 1);
}

TEST(TestFunctions, QuadraticHasConditionAndAxes) {
  const double angle = 0.4;
  const Quadratic f(50, angle);
  EXPECT_NEAR(f.at({std::cos(angle), std::sin(angle)}), 0.5, 1e-14);
  EXPECT_NEAR(f.at({-std::sin(angle), std::cos(angle)}), 25, 1e-13);
}

// With exact line searches, each direction is orthogonal to the one before, and every second one is the same: the
// zig-zag. From the worst initial guess on a quadratic, f decreases by ((k - 1) / (k + 1))^2 per iteration [Nocedal and
// Wright 2006, theorem 3.3].
TEST(TestFunctions, GradientDescentZigZagsOnQuadratic) {
  constexpr double kCondition = 20;
  Quadratic f(kCondition, 0.3);
  // The initial guess whose gradient has equal components along both axes.
  Planar p = {kCondition * std::cos(0.3) - std::sin(0.3), kCondition * std::sin(0.3) + std::cos(0.3)};
  GradientDescent descent;
  std::vector<Planar> directions;
  std::vector<double> values;
  for (int i = 0; i < 12; ++i) {
    const QuadraticModel m = f.model(p);
    const auto& [gx, gy] = m.gradient;
    MinimizeOptions options;
    options.max_iterations = 1;
    options.line_search.test = DecreaseTest::none;
    const double curvature = m.hessian.xx * gx * gx + 2 * m.hessian.xy * gx * gy + m.hessian.yy * gy * gy;
    options.line_search.alpha_max = (gx * gx + gy * gy) / curvature;  // exact minimum along -g
    std::vector<double> x = {p[0], p[1], 0};
    Minimizer().minimize(f, descent, x, options, [&](const LiveIteration& iteration) {
      directions.push_back({iteration.d[0], iteration.d[1]});
      values.push_back(iteration.value);
    });
    p = {x[0], x[1]};
  }
  const auto cosine = [&](size_t i, size_t j) {
    const Planar &a = directions[i], &b = directions[j];
    return (a[0] * b[0] + a[1] * b[1]) / std::hypot(a[0], a[1]) / std::hypot(b[0], b[1]);
  };
  const double rate = std::pow((kCondition - 1) / (kCondition + 1), 2);
  for (size_t i = 0; i + 2 < directions.size(); ++i) {
    EXPECT_NEAR(cosine(i, i + 1), 0, 1e-9);
    EXPECT_NEAR(cosine(i, i + 2), 1, 1e-9);
    EXPECT_NEAR(values[i + 1] / values[i], rate, 1e-9);
  }
}

TEST(TestFunctions, ModifiesHessian) {
  TwoBump f;
  const std::vector<double> x = {0.9, 0.4, 0};  // near the bump: negative definite
  const Mat3d exact = f.hessian(x, {}).block[0];
  EXPECT_LT(exact(0, 0), 0);
  const Mat3d absolute = f.hessian(x, {Definiteness::absolute}).block[0];
  for (int i = 0; i < 8; ++i) EXPECT_NEAR(absolute.a[i], -exact.a[i], 1e-14);  // all except z's
  EXPECT_EQ(f.projected_elements(), 1);
  const Mat3d clamped = f.hessian(x, {Definiteness::clamped}).block[0];
  EXPECT_GT(clamped(0, 0), 0);
  EXPECT_LT(clamped(0, 0), 1e-7);
}

TEST(TestFunctions, SuggestsNearestName) {
  try {
    make_test_function("rosenbrok");
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean 'rosenbrock'"), std::string::npos);
  }
}

}  // namespace
}  // namespace aspic
