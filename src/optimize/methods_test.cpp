// All methods on Rosenbrock's function, and their components.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "optimize/fallback_chain.h"
#include "optimize/hessian_policy.h"
#include "optimize/model_step.h"
#include "optimize/newton.h"
#include "optimize/preconditioner.h"
#include "optimize/solver.h"
#include "optimize/test_functions.h"

namespace aspic {
namespace {

MinimizeReport minimize_rosenbrock(const SolverOptions& options, std::vector<double>& x) {
  Rosenbrock f;
  MinimizeOptions minimize;
  minimize.tolerance = 1e-6;
  minimize.criterion = Criterion::absolute;
  minimize.max_iterations = 100'000;
  return Minimizer().minimize(f, *make_search_direction(options), x, minimize);
}

// The smallest eigenvalue of the Hessian at (1, 1) is 0.399, so |g| <= 1e-6 bounds the error by 2.5e-6.
TEST(Methods, MinimizeRosenbrockWithEveryPreconditioner) {
  for (const std::string& method : minimizer_names())
    for (const std::string& preconditioner : preconditioner_names()) {
      const SolverOptions options{.method = method, .preconditioner = preconditioner};
      if (find_conflict(options)) continue;  // the method ignores preconditioners
      // The preconditioner is stretched 100 : 1 across the valley at the initial guess, but along the valley at the
      // minimum.
      if (method == "gradient_descent" && (preconditioner == "diagonal" || preconditioner == "hessian")) continue;
      std::vector<double> x = {-0.8, 0.6, 0.3};
      const MinimizeReport report = minimize_rosenbrock(options, x);
      EXPECT_EQ(report.status, Status::converged) << method << ", " << preconditioner;
      EXPECT_NEAR(x[0], 1, 3e-6) << method << ", " << preconditioner;
      EXPECT_NEAR(x[1], 1, 6e-6) << method << ", " << preconditioner;
    }
}

TEST(Methods, MoreCurvatureTakesFewerIterations) {
  std::map<std::string, int> iterations;
  for (const std::string method : {"newton", "lbfgs", "nonlinear_cg", "gradient_descent"}) {
    std::vector<double> x = {-0.8, 0.6, 0};
    iterations[method] =
        minimize_rosenbrock({.method = method, .preconditioner = method == "newton" ? "auto" : "none"}, x).iterations;
  }
  EXPECT_LT(iterations["newton"], iterations["lbfgs"]);
  EXPECT_LT(5 * iterations["lbfgs"], iterations["gradient_descent"]);
  EXPECT_LT(5 * iterations["nonlinear_cg"], iterations["gradient_descent"]);
}

TEST(Methods, GradientDescentWithoutPreconditionerIsMinusGradient) {
  Rosenbrock f;
  const std::vector<double> x = {-0.8, 0.6, 0.3};
  std::vector<double> g(3), d(3);
  f.gradient(x, g);
  DirectionReport report;
  ASSERT_TRUE(make_search_direction({.method = "gradient_descent"})->compute({f, x, g}, d, report));
  for (int i = 0; i < 3; ++i) EXPECT_EQ(d[i], -g[i]);
}

// f = x' A x / 2 with the eigenvalues 1, 10 and 100.
class Parabola : public Objective {
 public:
  Parabola() : pattern_(make_pattern(1, {})), H_(pattern_) { H_.block[0] = {{1, 0, 0, 0, 10, 0, 0, 0, 100}}; }
  Evaluation evaluate(std::span<const double> x) override {
    return {(x[0] * x[0] + 10 * x[1] * x[1] + 100 * x[2] * x[2]) / 2};
  }
  void gradient(std::span<const double> x, std::span<double> g) override {
    g[0] = x[0], g[1] = 10 * x[1], g[2] = 100 * x[2];
  }
  const BlockSparse& evaluate_hessian(std::span<const double>, const Projection&) override {
    ++hessians;
    return H_;
  }
  int hessians = 0;

 private:
  BlockPattern pattern_;
  BlockSparse H_;
};

TEST(NonlinearCG, TakesOneIterationPerEigenvalue) {
  Parabola f;
  std::vector<double> x = {1, 1, 1};
  MinimizeOptions options;
  options.tolerance = 1e-6;  // steps from differences of gradients are accurate to seven digits
  options.criterion = Criterion::first_gradient;
  const auto method = make_search_direction({.method = "nonlinear_cg", .preconditioner = "none"});
  EXPECT_EQ(Minimizer().minimize(f, *method, x, options).iterations, 3);
}

// H <- (I - rho s y') H (I - rho y s') + rho s s' for each of the last eight steps, initialized with H = (s.y / y.y) I
// of the last one [Nocedal and Wright 2006, eq. 7.16 and 7.20].
TEST(LBFGS, MatchesMatrixRecursion) {
  for (int steps = 1; steps <= 10; ++steps) {
    Parabola f;
    const auto method = make_search_direction({.method = "lbfgs", .preconditioner = "none"});
    std::vector<double> x(3), g(3), d(3);
    std::vector<Eigen::Vector3d> places, gradients;
    DirectionReport report;
    for (int k = 0; k <= steps; ++k) {
      x = {std::cos(k), std::sin(2.0 * k), std::cos(3.0 * k)};
      f.gradient(x, g);
      ASSERT_TRUE(method->compute({f, x, g}, d, report));
      places.emplace_back(x.data()), gradients.emplace_back(g.data());
    }
    const auto change = [&](const auto& of, int k) { return Eigen::Vector3d(of[k] - of[k - 1]); };
    const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
    Eigen::Matrix3d H =
        change(places, steps).dot(change(gradients, steps)) / change(gradients, steps).squaredNorm() * I;
    for (int k = std::max(1, steps - 7); k <= steps; ++k) {
      const Eigen::Vector3d s = change(places, k), y = change(gradients, k);
      const double rho = 1 / s.dot(y);
      H = (I - rho * s * y.transpose()) * H * (I - rho * y * s.transpose()) + rho * s * s.transpose();
    }
    const Eigen::Vector3d expected = -H * gradients.back();
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(d[i], expected[i], 1e-11) << "after " << steps << " steps";
  }
}

TEST(Preconditioner, HessianSolvesQuadraticInOneStep) {
  for (const std::string method : {"gradient_descent", "nonlinear_cg", "lbfgs"}) {
    Parabola f;
    std::vector<double> x = {1, 1, 1};
    MinimizeOptions options;
    options.tolerance = 1e-6;
    const auto direction = make_search_direction({.method = method, .preconditioner = "hessian"});
    EXPECT_EQ(Minimizer().minimize(f, *direction, x, options).iterations, 1) << method;
    EXPECT_EQ(f.hessians, 1) << method;
  }
}

TEST(Preconditioner, MassIsIdentityWithoutMetric) {
  Rosenbrock f;
  DirectionReport report;
  const std::vector<double> x = {0, 0, 0}, r = {1, -2, 3};
  std::vector<double> z(3);
  ASSERT_TRUE(Preconditioner(PreconditionerKind::mass).apply(f, x, r, z, report));
  EXPECT_EQ(z, r);
  EXPECT_EQ(report.hessians, 0);
}

TEST(Preconditioner, IsKeptDuringMinimization) {
  Rosenbrock f;
  Preconditioner B(PreconditionerKind::hessian, "cholesky");
  DirectionReport report;
  const std::vector<double> here = {0, 1, 0}, there = {2, 0, 0}, r = {1, 2, 3};
  std::vector<double> first(3), again(3), anew(3);
  ASSERT_TRUE(B.apply(f, here, r, first, report));
  ASSERT_TRUE(B.apply(f, there, r, again, report));
  EXPECT_EQ(first, again);
  B.begin();
  ASSERT_TRUE(B.apply(f, there, r, anew, report));
  EXPECT_NE(first, anew);
  EXPECT_EQ(report.factorizations, 2);
}

TEST(ModelStep, ReachesMinimumOfParabola) {
  Parabola f;
  ModelStep step;
  DirectionReport report;
  const std::vector<double> x = {1, 1, 1}, p = {0, 0, -2};
  std::vector<double> g(3);
  f.gradient(x, g);
  EXPECT_NEAR(step.along({f, x, g}, p, report), 0.5, 1e-7);  // a length of 1 along z
  EXPECT_EQ(report.gradients, 1);
  Rosenbrock f2;
  const std::vector<double> saddle = {0, 1, 0};  // where the curvature along x is 2 - 400
  f2.gradient(saddle, g);
  const std::vector<double> along = {4, 0, 0};
  EXPECT_NEAR(step.along({f2, saddle, g}, along, report), 2.0 / 4, 1e-6);  // twice the length of the last step
}

TEST(Forcing, TightensQuadraticallyDownToBound) {
  Forcing forcing;
  forcing.begin();
  const InnerAccuracy accuracy{.loosest = 0.1, .enough = 0};
  EXPECT_DOUBLE_EQ(forcing.at(1, accuracy), 0.1);
  EXPECT_DOUBLE_EQ(forcing.at(0.1, accuracy), 0.9 * 0.01);
  EXPECT_DOUBLE_EQ(forcing.at(0.1, accuracy), 0.9 * 0.01);  // the same iterate again
  EXPECT_DOUBLE_EQ(forcing.at(0.09, accuracy), 0.1);        // 0.9^3 is too large
  EXPECT_DOUBLE_EQ(forcing.at(1e-9, accuracy), 1e-8);
  EXPECT_DOUBLE_EQ(forcing.at(1e-12, {.loosest = 0.1, .enough = 0.05}), 0.05);
  EXPECT_DOUBLE_EQ(forcing.at(1e-13, {.loosest = 1e-10, .enough = 0.05}), 1e-10);
}

TEST(Forcing, DoesNotTightenSuddenly) {
  Forcing forcing;
  forcing.begin();
  const InnerAccuracy loose{.loosest = 0.9, .enough = 0};
  EXPECT_DOUBLE_EQ(forcing.at(1, loose), 0.9);
  EXPECT_DOUBLE_EQ(forcing.at(0.1, loose), 0.9 * 0.81);  // not 0.9 * 0.01
}

TEST(ProgressiveProjection, GrowsFromLargestResiduals) {
  const std::vector<double> g = {1, 0, 0, 0, -0.6, 0, 0.3, 0, 0, 0, 0, 1e-3};
  ProgressiveProjection projection;
  projection.begin();
  EXPECT_EQ(projection.at(g).kind, Definiteness::exact);
  std::vector<int> covered;
  for (int i = 0; i < 40 && !projection.is_complete(); ++i) {
    projection.tighten(g);
    const Projection now = projection.at(g);
    EXPECT_EQ(now.kind, Definiteness::clamped);
    int count = 0;
    for (int v = 0; v < 4; ++v) count += now.covers(v);
    if (covered.empty() || covered.back() != count) covered.push_back(count);
  }
  EXPECT_EQ(covered, (std::vector<int>{2, 3, 4}));  // above 1/2, above 1/4, finally all
  EXPECT_TRUE(projection.is_complete());
  projection.begin();
  projection.tighten(g);
  projection.relax();
  EXPECT_EQ(projection.at(g).kind, Definiteness::exact);
}

// A method that succeeds if `works`, and logs its calls.
class Scripted : public SearchDirection {
 public:
  Scripted(std::string name, bool works, bool can_fall_back, std::string& log)
      : name_(std::move(name)), works_(works), can_fall_back_(can_fall_back), log_(log) {}
  std::string_view name() const override { return name_; }
  void begin() override { fallbacks_left_ = can_fall_back_; }
  bool compute(const Iterate& at, std::span<double> d, DirectionReport&) override {
    log_ += name_;
    for (size_t i = 0; i < d.size(); ++i) d[i] = -1e-3 * at.g[i];
    return works_;
  }
  bool fall_back() override { return std::exchange(fallbacks_left_, false); }

 private:
  std::string name_;
  bool works_, can_fall_back_, fallbacks_left_ = false;
  std::string& log_;
};

TEST(FallbackChain, UsesFallbacksOfEachMethodFirst) {
  std::string log;
  std::vector<std::unique_ptr<SearchDirection>> methods;
  methods.push_back(std::make_unique<Scripted>("a", false, true, log));
  methods.push_back(std::make_unique<Scripted>("b", false, false, log));
  methods.push_back(std::make_unique<Scripted>("c", true, false, log));
  FallbackChain chain(std::move(methods));
  Rosenbrock f;
  std::vector<double> x = {-0.8, 0.6, 0};
  MinimizeOptions options;
  options.max_iterations = 2;
  const MinimizeReport report = Minimizer().minimize(f, chain, x, options);
  EXPECT_EQ(log, "aabcaabc");
  EXPECT_EQ(report.fallbacks, 6);
  EXPECT_EQ(report.iterations, 2);
}

TEST(FallbackChain, FailsIfAllMethodsFail) {
  std::string log;
  std::vector<std::unique_ptr<SearchDirection>> methods;
  methods.push_back(std::make_unique<Scripted>("a", false, false, log));
  methods.push_back(std::make_unique<Scripted>("b", false, true, log));
  FallbackChain chain(std::move(methods));
  Rosenbrock f;
  std::vector<double> x = {-0.8, 0.6, 0};
  EXPECT_EQ(Minimizer().minimize(f, chain, x, {}).status, Status::no_descent);
  EXPECT_EQ(log, "abb");
}

TEST(FallbackChain, RescuesExactNewtonAtNegativeEigenvalue) {
  const std::vector<double> start = {0, 1, 0};
  std::vector<double> x = start;
  EXPECT_EQ(minimize_rosenbrock({.definiteness = "exact"}, x).status, Status::no_descent);
  for (const std::string fallback : {"gradient_descent", "lbfgs"}) {
    x = start;
    const MinimizeReport report = minimize_rosenbrock({.fallback = {fallback}, .definiteness = "exact"}, x);
    EXPECT_EQ(report.status, Status::converged) << fallback;
    EXPECT_GT(report.fallbacks, 0) << fallback;
    EXPECT_LT(report.fallbacks, report.iterations) << fallback << ": Newton's method takes over again";
  }
}

std::string conflict(const SolverOptions& options) {
  const auto found = find_conflict(options);
  return found ? found->option + ": " + found->reason : "";
}

TEST(SolverOptions, RejectsUnusedOptionsWithRemedy) {
  EXPECT_EQ(conflict({.method = "lbfgs", .definiteness = "clamped"}),
            "definiteness: definiteness = 'clamped' has no effect on lbfgs; methods that use it: newton, newton_cg "
            "(or leave it at 'auto')");
  EXPECT_EQ(conflict({.preconditioner = "mass"}),
            "preconditioner: preconditioner = 'mass' has no effect on newton; methods that use it: lbfgs, "
            "nonlinear_cg, gradient_descent (or leave it at 'auto')");
  EXPECT_NE(conflict({.method = "newton_cg", .linear = "cholesky"}), "");
  EXPECT_NE(conflict({.method = "lbfgs", .preconditioner = "mass", .linear = "cholesky"}), "");
  EXPECT_EQ(conflict({.method = "lbfgs", .linear = "cholesky"}), "");
  EXPECT_EQ(conflict({.method = "lbfgs", .fallback = {"newton"}, .definiteness = "clamped"}), "");
  EXPECT_EQ(conflict({.method = "gradient_decent"}).find("method: method = 'gradient_decent' is unknown"), 0u);
  EXPECT_THROW(make_search_direction({.method = "newton", .preconditioner = "mass"}), InvalidInput);
}

TEST(SolverOptions, DirectionCriteriaNeedMinimizerEstimates) {
  const auto with = [](const std::string& method, const std::vector<std::string>& fallback) {
    SolverOptions options{.method = method, .fallback = fallback};
    options.minimize.criterion = Criterion::velocity;
    return find_conflict(options);
  };
  for (const std::string& method : minimizer_names())
    EXPECT_EQ(with(method, {}).has_value(), !make_search_direction({.method = method})->estimates_minimizer())
        << method;
  EXPECT_FALSE(with("newton", {"newton_cg"}));
  EXPECT_EQ(with("newton", {"lbfgs"})->option, "criterion");
}

TEST(SolverOptions, MakesEveryMethodByName) {
  for (const std::string& method : minimizer_names()) {
    const auto direction = make_search_direction({.method = method});
    EXPECT_EQ(direction->name(), method);
    EXPECT_EQ(direction->description().find(method), 0u);
  }
  EXPECT_EQ(make_search_direction({.method = "newton", .fallback = {"gradient_descent"}})->description(),
            "newton, definiteness on_demand, auto; fallback: gradient_descent, preconditioner none");
}

}  // namespace
}  // namespace aspic
