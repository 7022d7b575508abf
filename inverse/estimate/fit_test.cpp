#include "estimate/fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/error.h"
#include "mesh/generators.h"
#include "model/parameter_map.h"

namespace aspic {
namespace {

using testing::HasSubstr;

std::vector<double> normal(size_t n, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> gauss;
  std::vector<double> v(n);
  for (double& x : v) x = gauss(random);
  return v;
}

// r = (A phi(p) - b) / sigma with phi(p) = p + bend p^2 / 2 component by component.
class CurvedModel : public LeastSquares {
 public:
  CurvedModel(int parameter_count, int residuals, double bend, double sigma)
      : n_(parameter_count),
        m_(residuals),
        bend_(bend),
        sigma_(sigma),
        A_(normal(static_cast<size_t>(parameter_count) * residuals, 3)),
        b_(residuals) {}

  // Generates b from these parameters, with noise.
  void observe(std::span<const double> p, double noise) {
    std::vector<double> r(m_);
    std::fill(b_.begin(), b_.end(), 0.0);
    evaluate(p, r);
    const std::vector<double> e = normal(r.size(), 4);
    for (int i = 0; i < m_; ++i) b_[i] = r[i] * sigma_ + noise * sigma_ * e[i];
  }
  // Low-pass model: each row averages neighbors.
  void blur(double width) {
    for (int i = 0; i < m_; ++i)
      for (int j = 0; j < n_; ++j) {
        const double x = ((i + 0.5) / m_ - (j + 0.5) / n_) / width;
        A(i, j) = std::exp(-x * x / 2) / (n_ * width * std::sqrt(2 * M_PI));
      }
  }

  int parameter_count() const override { return n_; }
  int residual_count() const override { return m_; }
  bool evaluate(std::span<const double> p, std::span<double> r) override {
    ++evaluations;
    for (double pi : p)
      if (std::abs(pi) > bound) return false;
    p_.assign(p.begin(), p.end());
    for (int i = 0; i < m_; ++i) {
      double sum = 0;
      for (int j = 0; j < n_; ++j) sum += A(i, j) * (p[j] + bend_ * p[j] * p[j] / 2);
      r[i] = (sum - b_[i]) / sigma_;
    }
    return true;
  }
  bool linearize() override { return !breaks; }
  void multiply(std::span<const double> dp, std::span<double> dr) override {
    for (int i = 0; i < m_; ++i) {
      dr[i] = 0;
      for (int j = 0; j < n_; ++j) dr[i] += A(i, j) * (1 + bend_ * p_[j]) * dp[j] / sigma_;
    }
  }
  void multiply_transposed(std::span<const double> w, std::span<double> pbar) override {
    for (int j = 0; j < n_; ++j) {
      pbar[j] = 0;
      for (int i = 0; i < m_; ++i) pbar[j] += A(i, j) * (1 + bend_ * p_[j]) * w[i] / sigma_;
    }
  }
  const std::vector<double>& last() const { return p_; }

  double bound = 1e9;  // the model is undefined beyond it
  bool breaks = false;
  int evaluations = 0;

 private:
  double& A(int i, int j) { return A_[static_cast<size_t>(i) * n_ + j]; }

  int n_, m_;
  double bend_, sigma_;
  std::vector<double> A_, b_, p_;
};

// A field over the tets of a bar along x, one tet after another.
struct Bar {
  TetMesh mesh = make_box({{0, 0, 0}}, {{20, 1, 1}}, {20, 1, 1});
  ParameterMap map{mesh,
                   "neo_hookean",
                   std::vector<MaterialParameters>(mesh.tets.size(), {lame_from_young_poisson(1, 0.3), {}}),
                   {{"young", Parameterization::tets, 0, 1.0}}};  // the guess is log E = 0

  std::vector<double> truth() const {  // a stiff inclusion
    std::vector<double> z;
    for (const auto& [a, b, c, d] : mesh.tets) {
      const double x = (mesh.rest[a][0] + mesh.rest[b][0] + mesh.rest[c][0] + mesh.rest[d][0]) / 4;
      z.push_back(x > 8 && x < 12 ? std::log(5) : 0);
    }
    return z;
  }
};

struct Few {
  TetMesh mesh = [] {
    TetMesh box = make_box({{0, 0, 0}}, {{3, 1, 1}}, {3, 1, 1});
    for (int t = 0; t < box.tet_count(); ++t) box.region.push_back(t / 6);
    return box;
  }();
  ParameterMap map{mesh,
                   "neo_hookean",
                   std::vector<MaterialParameters>(mesh.tets.size(), {lame_from_young_poisson(1, 0.3), {}}),
                   {{"young", Parameterization::regions, 0, 1.0}}};
  std::unique_ptr<Regularizer> prior = make_regularizer(mesh, map, {});
};

double largest_difference(std::span<const double> a, std::span<const double> b) {
  double largest = 0;
  for (size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

class Methods : public testing::TestWithParam<const char*> {};

TEST_P(Methods, FindFewParametersFromExactData) {
  Few few;
  CurvedModel model(3, 8, 0.3, 1e-6);
  const std::vector<double> truth{0.7, -0.4, 1.2};
  model.observe(truth, 0);
  const FitReport report =
      fit(model, *few.prior, few.map.guess(), {.method = GetParam(), .tolerance = 1e-9, .enough = 0, .weight = 1});
  EXPECT_TRUE(is_success(report.status)) << report.message;
  EXPECT_LT(largest_difference(report.p, truth), 1e-7);
  EXPECT_EQ(report.method, GetParam());
}

// The minimizer of a quadratic has zero gradient, computed by differences of the definition.
TEST_P(Methods, EndWhereTheGradientIsZero) {
  Bar bar;
  CurvedModel model(bar.map.size(), 40, 0, 0.1);
  model.blur(0.05);
  model.observe(bar.truth(), 1);
  const auto R = make_regularizer(bar.mesh, bar.map, {});
  const FitReport report =
      fit(model, *R, bar.map.guess(),
          {.method = GetParam(), .tolerance = 1e-6, .enough = 0, .max_iterations = 500, .weight = 2});
  ASSERT_TRUE(is_success(report.status)) << report.message;
  std::vector<double> r(40), g(report.p.size()), first(report.p.size());
  const auto gradient = [&](std::span<const double> p, std::span<double> to) {
    model.evaluate(p, r);
    model.multiply_transposed(r, to);
    R->add_gradient(p, 2, to);
  };
  gradient(bar.map.guess(), first);
  gradient(report.p, g);
  const auto norm = [](const std::vector<double>& v) {
    return std::sqrt(std::inner_product(v.begin(), v.end(), v.begin(), 0.0));
  };
  EXPECT_LT(norm(g), 1e-5 * norm(first));
}

TEST_P(Methods, TakeAFailedEvaluationAsTooFar) {
  Few few;
  CurvedModel model(3, 8, 0.5, 1e-3);
  const std::vector<double> truth{0.9, 0.9, 0.9};
  model.observe(truth, 0);
  model.bound = 1.0;
  const FitReport report =
      fit(model, *few.prior, few.map.guess(), {.method = GetParam(), .tolerance = 1e-8, .enough = 0, .weight = 0});
  EXPECT_TRUE(is_success(report.status)) << report.message;
  EXPECT_LT(largest_difference(report.p, truth), 1e-5);
}

TEST_P(Methods, NeverCallAFailureSuccess) {
  Few few;
  CurvedModel model(3, 8, 0.3, 1e-3);
  model.observe(std::vector{1.0, 1.0, 1.0}, 0);
  model.breaks = true;
  EXPECT_FALSE(is_success(fit(model, *few.prior, few.map.guess(), {.method = GetParam()}).status));
  model.breaks = false;
  model.bound = -1;
  const FitReport nowhere = fit(model, *few.prior, few.map.guess(), {.method = GetParam()});
  EXPECT_EQ(nowhere.status, Status::undefined);
  EXPECT_THAT(nowhere.message, HasSubstr("could not be evaluated"));
  model.bound = 1e-3;  // the data favor points outside the domain
  EXPECT_FALSE(
      is_success(fit(model, *few.prior, few.map.guess(), {.method = GetParam(), .max_iterations = 30}).status));
}

TEST_P(Methods, ShowEveryIterateAndStopOnDemand) {
  Few few;
  CurvedModel model(3, 8, 0.5, 1e-3);
  model.observe(std::vector{1.0, -0.5, 0.3}, 0);
  std::vector<double> seen;
  bool is_done = false;
  const auto observe = [&](const FitIteration& i, std::span<const double> p) {
    seen.assign(p.begin(), p.end());
    is_done = i.index == 1;
  };
  const FitOptions options{.method = GetParam(), .stop = StopToken([&] { return is_done; })};
  const FitReport report = fit(model, *few.prior, few.map.guess(), options, observe);
  EXPECT_EQ(report.status, Status::interrupted);
  EXPECT_EQ(report.history.size(), 2u);
  EXPECT_EQ(report.p, seen);
  EXPECT_EQ(model.last(), seen) << "the model was last evaluated there";
  const FitReport resumed = fit(model, *few.prior, report.p, {.method = GetParam(), .tolerance = 1e-8, .enough = 0});
  const FitReport whole =
      fit(model, *few.prior, few.map.guess(), {.method = GetParam(), .tolerance = 1e-8, .enough = 0});
  EXPECT_LT(largest_difference(resumed.p, whole.p), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Of, Methods, testing::Values("levenberg_marquardt", "gauss_newton_cg"),
                         [](const auto& each) { return std::string(each.param); });

// A model whose Jacobian has a relative error, like one with differences.
class InaccurateModel : public CurvedModel {
 public:
  using CurvedModel::CurvedModel;
  double error = 0;

  void multiply(std::span<const double> dp, std::span<double> dr) override {
    CurvedModel::multiply(dp, dr);
    for (size_t i = 0; i < dr.size(); ++i) dr[i] += error * wrong_[i] * dp[0];
  }
  void multiply_transposed(std::span<const double> w, std::span<double> pbar) override {
    CurvedModel::multiply_transposed(w, pbar);
    for (size_t i = 0; i < w.size(); ++i) pbar[0] += error * wrong_[i] * w[i];
  }

 private:
  std::vector<double> wrong_ = normal(static_cast<size_t>(residual_count()), 6);
};

TEST(Fit, ConvergesWithinTheErrorOfTheJacobian) {
  Few few;
  InaccurateModel model(3, 200, 0, 1);
  model.observe(std::vector{0.7, -0.4, 1.2}, 1);
  const FitReport exact = fit(model, *few.prior, few.map.guess(), {.tolerance = 1e-9, .weight = 0});
  ASSERT_TRUE(is_success(exact.status)) << exact.message;
  model.error = 4e-4;  // no step improves the fit
  const FitReport close = fit(model, *few.prior, exact.p, {.weight = 0});
  EXPECT_TRUE(is_success(close.status)) << close.message;
  ASSERT_FALSE(close.history.empty());
  EXPECT_GT(close.history.back().decrement, 1e-4);
  EXPECT_LT(largest_difference(close.p, exact.p), 1e-6);
  model.error = 0.1;
  EXPECT_FALSE(is_success(fit(model, *few.prior, exact.p, {.weight = 0}).status));
}

TEST(Fit, ObjectiveNeverGrowsAtOneWeight) {
  Bar bar;
  CurvedModel model(bar.map.size(), 40, 0.4, 0.01);
  model.blur(0.05);
  model.observe(bar.truth(), 1);
  const auto R = make_regularizer(bar.mesh, bar.map, {Smoothness::total_variation});
  const FitReport report = fit(model, *R, bar.map.guess(), {.weight = 1});
  ASSERT_TRUE(is_success(report.status)) << report.message;
  for (size_t i = 1; i < report.history.size(); ++i)
    EXPECT_LE(report.history[i].objective, report.history[i - 1].objective * (1 + 1e-9));
}

// Purpose of the rule: |r|^2 equals the expectation of the noise.
TEST(Fit, DiscrepancyLeavesTheNoise) {
  Bar bar;
  for (Smoothness smoothness : {Smoothness::h1, Smoothness::total_variation}) {
    CurvedModel model(bar.map.size(), 200, 0, 0.02);
    model.blur(0.03);
    model.observe(bar.truth(), 1);
    const auto R = make_regularizer(bar.mesh, bar.map, {smoothness});
    const FitReport report = fit(model, *R, bar.map.guess(), {.weight_rule = "discrepancy"});
    ASSERT_TRUE(is_success(report.status)) << report.message;
    EXPECT_NEAR(2 * report.misfit, 200, 0.15 * 200);
    EXPECT_GE(report.weights.size(), 2u);
    EXPECT_LT(report.weights.front().misfit, report.weights.back().misfit);
    EXPECT_LT(largest_difference(report.p, bar.truth()), 1.0);
  }
}

TEST(Fit, ReportsDataThatTheModelCannotExplain) {
  Bar bar;
  CurvedModel model(bar.map.size(), 200, 0, 0.02);
  model.blur(0.2);
  model.observe(bar.truth(), 10);  // noise ten times what is stated
  const auto R = make_regularizer(bar.mesh, bar.map, {});
  const FitReport report = fit(model, *R, bar.map.guess(), {.max_iterations = 300, .weight_rule = "discrepancy"});
  EXPECT_TRUE(is_success(report.status)) << report.message;
  EXPECT_THAT(report.message, HasSubstr("too small"));
}

// The result is the same for initial weights far above and far below.
TEST(Fit, FindsWeightOfLargestEvidence) {
  Bar bar;
  CurvedModel model(bar.map.size(), 200, 0, 0.02);
  model.blur(0.03);
  model.observe(bar.truth(), 1);
  const auto R = make_regularizer(bar.mesh, bar.map, {});
  std::vector<double> found;
  for (const double first : {1e-2, 1.0, 1e4}) {
    const FitReport report =
        fit(model, *R, bar.map.guess(), {.max_iterations = 300, .weight_rule = "evidence", .first_weight = first});
    ASSERT_TRUE(is_success(report.status)) << report.message;
    EXPECT_THAT(report.message, HasSubstr("maximizes the evidence"));
    EXPECT_LT(2 * report.misfit, 200 * 1.2);
    found.push_back(report.weight);
  }
  EXPECT_NEAR(std::log(found[0] / found[2]), 0, 0.7);
  EXPECT_NEAR(std::log(found[1] / found[2]), 0, 0.7);
}

// phi has two branches, p and -2 / bend - p. From the wrong side of the ridge a descent ends at the other one.
TEST(Fit, KeepsTheBestOfManyStarts) {
  Few few;
  CurvedModel model(3, 8, 1, 0.05);
  model.observe(std::vector{1.0, -0.6, 0.4}, 0);
  const FitReport many = fit(model, *few.prior, std::vector{-1.4, -1.4, -1.4}, {.starts = 6, .scatter = 3});
  ASSERT_EQ(many.starts.size(), 6u);
  EXPECT_DOUBLE_EQ(many.misfit + many.weight * many.roughness,
                   *std::min_element(many.starts.begin(), many.starts.end()));
  EXPECT_LT(many.misfit + many.weight * many.roughness, 0.9 * many.starts[0]);
}

TEST(Fit, RefusesUnknownNamesAndBadNumbers) {
  Few few;
  CurvedModel model(3, 8, 0, 1);
  const auto refusal = [&](const FitOptions& options) {
    try {
      fit(model, *few.prior, few.map.guess(), options);
      return std::string("accepted");
    } catch (const InvalidInput& error) {
      return std::string(error.what());
    }
  };
  EXPECT_THAT(refusal({.method = "gauss_newton"}), HasSubstr("did you mean 'gauss_newton_cg'?"));
  EXPECT_THAT(refusal({.weight_rule = "evidnce"}), HasSubstr("did you mean 'evidence'?"));
  EXPECT_THAT(refusal({.tolerance = 0}), HasSubstr("must be positive"));
  EXPECT_THAT(refusal({.weight = std::nan("")}), HasSubstr("must be finite"));
  EXPECT_THAT(refusal({.starts = 0}), HasSubstr("must be positive"));
}

}  // namespace
}  // namespace aspic
