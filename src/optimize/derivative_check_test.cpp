#include "optimize/derivative_check.h"

#include <gtest/gtest.h>

#include <cmath>

#include "optimize/test_functions.h"

namespace aspic {
namespace {

const std::vector<double> kPoint = {-0.8, 0.6, 0.1};

TEST(DerivativeCheck, FindsSlopeTwoForSmoothFunctions) {
  for (const TestFunction& info : test_functions()) {
    const auto f = make_test_function(info.name);
    const DerivativeReport report = check_derivatives(differentiable(*f), kPoint);
    EXPECT_TRUE(report.passed()) << info.name;
    EXPECT_EQ(report.gradient.step.size(), 9u);
    if (info.name == "quadratic") {  // its differences have only round-off errors
      EXPECT_TRUE(std::isnan(report.gradient.order));
      EXPECT_TRUE(std::isnan(report.hessian.order));
    } else {
      EXPECT_NEAR(report.gradient.order, 2, 0.1) << info.name;
      EXPECT_NEAR(report.hessian.order, 2, 0.1) << info.name;
    }
  }
}

// f = sum of x_i^4 over 40 entries, with one wrong derivative.
class Quartic : public Objective {
 public:
  int wrong_gradient = -1, wrong_row = -1, wrong_column = -1;
  double factor = 1.001;  // factor of the wrong derivative
  Quartic() : pattern_(make_pattern(14, couplings())), H_(pattern_) {}
  Evaluation evaluate(std::span<const double> x) override {
    double sum = 0;
    for (size_t i = 0; i + 1 < x.size(); ++i) sum += std::pow(x[i], 4) + x[i] * x[i + 1] * x[i + 1];
    return {sum};
  }
  void gradient(std::span<const double> x, std::span<double> g) override {
    std::fill(g.begin(), g.end(), 0.0);
    for (size_t i = 0; i + 1 < x.size(); ++i) {
      g[i] += 4 * std::pow(x[i], 3) + x[i + 1] * x[i + 1];
      g[i + 1] += 2 * x[i] * x[i + 1];
    }
    if (wrong_gradient >= 0) g[wrong_gradient] *= factor;
  }
  const BlockSparse& evaluate_hessian(std::span<const double> x, const Projection&) override {
    H_.set_zero();
    const auto entry = [&](size_t r, size_t c) -> double& {  // c <= r
      return H_.block[pattern_.slot(static_cast<int>(r / 3), static_cast<int>(c / 3))](static_cast<int>(r % 3),
                                                                                       static_cast<int>(c % 3));
    };
    const auto add = [&](size_t r, size_t c, double h) {
      if (static_cast<int>(r) == wrong_row && static_cast<int>(c) == wrong_column) h *= factor;
      entry(r, c) += h;
      if (r != c && r / 3 == c / 3) entry(c, r) += h;
    };
    for (size_t i = 0; i + 1 < x.size(); ++i) {
      add(i, i, 12 * x[i] * x[i]);
      add(i + 1, i + 1, 2 * x[i]);
      add(i + 1, i, 2 * x[i + 1]);
    }
    return H_;
  }

 private:
  static Couplings couplings() {
    Couplings pairs;
    for (int i = 0; i + 1 < 14; ++i) pairs.emplace_back(i, i + 1);
    return pairs;
  }
  BlockPattern pattern_;
  BlockSparse H_;
};

std::vector<double> quartic_point() {
  std::vector<double> x;
  for (int i = 0; i < 42; ++i) x.push_back(0.5 + 0.3 * std::sin(7 * i));
  return x;
}

TEST(DerivativeCheck, AcceptsCorrectGradientAndHessian) {
  Quartic f;
  EXPECT_TRUE(check_derivatives(differentiable(f), quartic_point()).passed());
}

TEST(DerivativeCheck, NamesWrongGradientEntry) {
  for (const int wrong : {0, 17, 41}) {
    Quartic f;
    f.wrong_gradient = wrong;
    const DerivativeCheck check = check_derivatives(differentiable(f), quartic_point()).gradient;
    EXPECT_FALSE(check.passed);
    EXPECT_EQ(check.row, wrong);
    EXPECT_NEAR(check.found / check.expected, 1.001, 1e-7);
    EXPECT_FALSE(check.order > 1.5);  // the error does not decrease
  }
}

TEST(DerivativeCheck, NamesWrongHessianEntry) {
  for (const auto& [row, column] : {std::pair{8, 8}, std::pair{30, 29}}) {
    Quartic f;
    f.wrong_row = row, f.wrong_column = column;
    const DerivativeReport report = check_derivatives(differentiable(f), quartic_point());
    EXPECT_TRUE(report.gradient.passed);
    EXPECT_FALSE(report.hessian.passed);
    // An off-diagonal entry occurs in two rows.
    EXPECT_EQ(std::max(report.hessian.row, report.hessian.column), row);
    EXPECT_EQ(std::min(report.hessian.row, report.hessian.column), column);
    EXPECT_GT(report.hessian.found / report.hessian.expected, 1.0005);
  }
}

TEST(DerivativeCheck, IgnoresFixedEntries) {
  Quartic f;
  f.wrong_gradient = 17;
  DerivativeCheckOptions options;
  options.fixed.assign(42, 0);
  options.fixed[17] = 1;
  EXPECT_TRUE(check_derivatives(differentiable(f), quartic_point(), options).gradient.passed);
}

TEST(DerivativeCheck, SkipsStepsOutsideDomain) {
  Differentiable f;  // -log x - log y - log z
  f.value = [](std::span<const double> x) {
    double sum = 0;
    for (const double xi : x) sum -= std::log(xi);
    return sum;
  };
  f.gradient = [](std::span<const double> x, std::span<double> g) {
    for (size_t i = 0; i < x.size(); ++i) g[i] = -1 / x[i];
  };
  f.hessian_times = [](std::span<const double> x, std::span<const double> d, std::span<double> Hd) {
    for (size_t i = 0; i < x.size(); ++i) Hd[i] = d[i] / (x[i] * x[i]);
  };
  const DerivativeReport report = check_derivatives(f, std::vector<double>{0.02, 0.03, 0.01});
  EXPECT_TRUE(std::isnan(report.gradient.error.front()));
  EXPECT_TRUE(report.passed());
}

}  // namespace
}  // namespace aspic
