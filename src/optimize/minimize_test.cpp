#include "optimize/minimize.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>

#include "optimize/gradient_descent.h"
#include "optimize/lag_updates.h"
#include "optimize/newton.h"
#include "optimize/test_functions.h"

namespace aspic {
namespace {

MinimizeOptions tight() {
  MinimizeOptions options;
  options.tolerance = 1e-10;
  options.criterion = Criterion::absolute;
  return options;
}

std::unique_ptr<Newton> newton_with(NewtonDefiniteness definiteness = NewtonDefiniteness::on_demand) {
  return std::make_unique<Newton>(make_linear_solver("block_jacobi"), definiteness);
}

TEST(Minimize, NewtonMinimizesRosenbrock) {
  for (const double x0 : {-0.8, 0.9, -1.5}) {
    Rosenbrock f;
    std::vector<double> x = {x0, 0.6, 0};
    const MinimizeReport report = Minimizer().minimize(f, *newton_with(), x, tight());
    EXPECT_EQ(report.status, Status::converged);
    EXPECT_NEAR(x[0], 1, 1e-8);
    EXPECT_NEAR(x[1], 1, 1e-8);
    EXPECT_LT(report.iterations, 40);
  }
}

TEST(Minimize, GradientDescentDecreasesMonotonically) {
  Rosenbrock f;
  GradientDescent direction;
  std::vector<double> x = {-0.8, 0.6, 0};
  MinimizeOptions options = tight();
  options.tolerance = 1e-3;
  options.max_iterations = 20000;
  double last = INFINITY;
  const MinimizeReport report = Minimizer().minimize(f, direction, x, options, [&](const Iteration& iteration) {
    EXPECT_LT(iteration.value, last);
    last = iteration.value;
  });
  EXPECT_EQ(report.status, Status::converged);
  EXPECT_GT(report.iterations, 200);
}

TEST(Minimize, NewtonWithoutLineSearchOvershoots) {
  Rosenbrock f;
  std::vector<double> x = {-0.8, 0.6, 0};
  MinimizeOptions options = tight();
  options.line_search.test = DecreaseTest::none;
  bool rose = false;
  double last = f.value(x);
  Minimizer().minimize(f, *newton_with(), x, options, [&](const Iteration& iteration) {
    rose = rose || iteration.value > last;
    last = iteration.value;
  });
  EXPECT_TRUE(rose);
}

TEST(Minimize, IndefiniteHessianIsModifiedOnDemand) {
  Rosenbrock f;
  std::vector<double> x = {0, 1, 0};  // the Hessian there has one negative eigenvalue
  EXPECT_EQ(Minimizer().minimize(f, *newton_with(NewtonDefiniteness::exact), x, tight()).status, Status::no_descent);
  const MinimizeReport report = Minimizer().minimize(f, *newton_with(), x, tight());
  EXPECT_EQ(report.status, Status::converged);
  EXPECT_GT(report.projected_hessians, 0);
}

// NaN beyond a distance of two.
class Island : public Rosenbrock {
 public:
  Evaluation evaluate(std::span<const double> x) override {
    const Evaluation E = x[0] * x[0] + x[1] * x[1] < 4 ? Rosenbrock::evaluate(x) : Evaluation{NAN};
    met_nan = met_nan || std::isnan(E.value);
    return E;
  }
  bool met_nan = false;
};

TEST(Minimize, LineSearchRejectsNaN) {
  Island f;
  GradientDescent direction;
  std::vector<double> x = {-0.8, 0.6, 0};
  MinimizeOptions options = tight();
  options.max_iterations = 20;
  options.line_search.alpha_max = 1e4;
  Minimizer().minimize(f, direction, x, options, [&](const LiveIteration& iteration) {
    for (const Trial& trial : iteration.tried) EXPECT_FALSE(trial.accepted && std::isnan(trial.value));
    EXPECT_TRUE(std::isfinite(iteration.value));
  });
  EXPECT_TRUE(f.met_nan);
  EXPECT_LT(x[0] * x[0] + x[1] * x[1], 4);
}

// f = ((x - c)^2 + y^2) / 2, where c = 3 - 2 x at the last update: updates alternate about x = 1, further each time.
class Alternating : public PlanarFunction, public HasLag {
 public:
  explicit Alternating(bool relaxes) : relaxes_(relaxes) {}
  double at(const Planar& p) const override { return ((p[0] - c_) * (p[0] - c_) + p[1] * p[1]) / 2; }
  Planar gradient_at(const Planar& p) const override { return {p[0] - c_, p[1]}; }
  PlanarHessian hessian_at(const Planar&) const override { return {1, 0, 1}; }
  ObjectiveTraits traits() override { return {.lag = this}; }
  bool is_lagged() const override { return true; }
  void update_lagged(std::span<const double> x, bool) override { before_ = std::exchange(c_, 3 - 2 * x[0]); }
  bool relax_lagged() override {
    if (relaxes_) c_ = before_ + (c_ - before_) / 3;
    return relaxes_;
  }

 private:
  bool relaxes_;
  double c_ = 0, before_ = 0;
};

TEST(LagUpdates, LateOnesAreMadeAtMinimizersAlone) {
  Alternating f(false);
  LagUpdates lag;
  lag.begin(&f);
  MinimizeReport report;
  const std::vector<double> x = {0, 0, 0};
  int early = 0;
  for (report.reached = 1; lag.note_step(), lag.is_due(report, {}) && early < 100; report.reached /= 2, ++early) {
    lag.update(x);
    lag.end_after(report, 0, {}, {});
  }
  EXPECT_GT(early, 20);
  EXPECT_LT(early, 100);
  EXPECT_TRUE(lag.is_due(report, Status::converged));
}

TEST(Minimize, AlternatingUpdatesAreRelaxed) {
  for (const bool relaxes : {true, false}) {
    Alternating f(relaxes);
    std::vector<double> x = {0.3, 0.6, 0};
    MinimizeOptions options = tight();
    options.updates_lagged = true;
    const MinimizeReport report = Minimizer().minimize(f, *newton_with(), x, options);
    EXPECT_EQ(report.status == Status::converged, relaxes);
    EXPECT_EQ(std::abs(x[0] - 1) < 1e-9, relaxes);
  }
}

TEST(Minimize, IterationLimitIsNotSuccess) {
  Rosenbrock f;
  std::vector<double> x = {-0.8, 0.6, 0};
  MinimizeOptions options = tight();
  options.max_iterations = 2;
  const MinimizeReport report = Minimizer().minimize(f, *newton_with(), x, options);
  EXPECT_EQ(report.status, Status::iteration_limit);
  EXPECT_FALSE(is_success(report.status));
  EXPECT_EQ(report.iterations, 2);
}

TEST(Minimize, NonFiniteInitialGuessIsUndefined) {
  Rosenbrock f;
  std::vector<double> x = {NAN, 0, 0};
  EXPECT_EQ(Minimizer().minimize(f, *newton_with(), x, tight()).status, Status::undefined);
}

TEST(Minimize, StopsOnRequestAfterIteration) {
  Rosenbrock f;
  std::vector<double> x = {-0.8, 0.6, 0};
  int last = 0;
  MinimizeOptions options = tight();
  options.stop = StopToken([&] { return last == 3; });
  const MinimizeReport report =
      Minimizer().minimize(f, *newton_with(), x, options, [&](const Iteration& iteration) { last = iteration.index; });
  EXPECT_EQ(report.status, Status::interrupted);
  EXPECT_EQ(report.iterations, 4);
}

// The sign of the gradient is wrong, so no step along -g decreases the function.
class Deceptive : public Rosenbrock {
 public:
  Deceptive(double gradient_round_off, double gradient_scale)
      : gradient_round_off_(gradient_round_off), gradient_scale_(gradient_scale) {}
  void gradient(std::span<const double> x, std::span<double> g) override {
    Rosenbrock::gradient(x, g);
    for (double& gi : g) gi = -gi;
  }
  ObjectiveScales scales() const override {
    return {.gradient = gradient_scale_, .gradient_round_off = gradient_round_off_};
  }

 private:
  double gradient_round_off_, gradient_scale_;
};

TEST(Minimize, AcceptsFailedLineSearchOnlyNearRoundOff) {
  const std::vector<double> start = {0, 0, 0};  // |g| = 2
  const auto status = [&](double gradient_round_off, double gradient_scale = 1e4) {
    Deceptive f(gradient_round_off, gradient_scale);
    GradientDescent direction;
    std::vector<double> x = start;
    return Minimizer().minimize(f, direction, x, tight()).status;
  };
  EXPECT_EQ(status(0), Status::stuck);
  EXPECT_EQ(status(0.01), Status::stuck);     // 200 times below |g|
  EXPECT_EQ(status(0.1), Status::round_off);  // 20 times
  EXPECT_EQ(status(3), Status::round_off);    // above: no line search
  EXPECT_EQ(status(3, 10), Status::stuck);    // the gradient is entirely round-off
  EXPECT_FALSE(is_success(Status::stuck));
}

TEST(Minimize, ToleranceIsRelativeToCriterionScale) {
  const auto threshold = [](Criterion criterion) {
    Rosenbrock f;
    std::vector<double> x = {0, 0.5, 0};  // g = (-2, 100, 0)
    MinimizeOptions options;
    options.tolerance = 0.5;
    options.criterion = criterion;
    return Minimizer().minimize(f, *newton_with(), x, options).threshold;
  };
  EXPECT_EQ(threshold(Criterion::absolute), 0.5);
  EXPECT_EQ(threshold(Criterion::scale), 0.5);  // the scale of a plain function is 1
  EXPECT_NEAR(threshold(Criterion::first_gradient), 0.5 * std::hypot(2, 100), 1e-12);
}

TEST(Minimize, StatusAndCriterionNamesAreUnique) {
  std::set<std::string_view> names;
  for (const Status status : {Status::converged, Status::round_off, Status::budget, Status::iteration_limit,
                              Status::stuck, Status::no_descent, Status::interrupted, Status::undefined})
    names.insert(to_string(status));
  for (const Criterion criterion : {Criterion::scale, Criterion::first_gradient, Criterion::absolute})
    names.insert(to_string(criterion));
  EXPECT_EQ(names.size(), 11u);
  EXPECT_FALSE(names.contains("unknown"));
}

TEST(LineSearch, TextbookAndSlideTestsDifferByAlpha) {
  // Along d = (0.005, 0) from (0, 0), f decreases by 2 alpha 0.005 to first order. With c = 0.6, the textbook test
  // accepts small alpha, while the slide's test requires the full decrease for any alpha.
  Rosenbrock f;
  const std::vector<double> x = {0, 0, 0}, d = {0.5, 0, 0};
  LineSearchScratch scratch{std::vector<double>(3), std::vector<double>(3), {}};
  LineSearchOptions options;
  options.sufficient_decrease = 0.6;
  const LineSearchResult textbook = backtrack({f, x, d, {f.value(x)}, -1}, options, scratch);
  EXPECT_GT(textbook.alpha, 0);
  EXPECT_LE(f.value(std::vector<double>{textbook.alpha * 0.5, 0, 0}), 1 - 0.6 * textbook.alpha);
  options.test = DecreaseTest::slide;
  EXPECT_EQ(backtrack({f, x, d, {f.value(x)}, -1}, options, scratch).alpha, 0);  // stuck
}

// f(x) = 8 x^2 + 1e9, whose differences near the minimum are below the round-off of 1e9.
class OffsetParabola : public Objective {
 public:
  Evaluation evaluate(std::span<const double> x) override { return {8 * x[0] * x[0] + 1e9, 1e-7}; }
  void gradient(std::span<const double> x, std::span<double> g) override { g[0] = 16 * x[0]; }
  const BlockSparse& evaluate_hessian(std::span<const double>, const Projection&) override {
    throw std::logic_error("not needed");
  }
};

TEST(LineSearch, TakesTheStepsOfACustomSearch) {
  Rosenbrock f;
  std::vector<double> x = {-0.8, 0.6, 0};
  MinimizeOptions options = tight();
  // Halves the step until E decreases by a tenth of the slope.
  options.line_search.custom = [](const SearchLine& line) {
    EXPECT_DOUBLE_EQ(line.E.dot(line.g, line.d), line.slope);
    for (double alpha = 1; alpha > 1e-10; alpha /= 2) {
      std::vector<double> trial(line.x.begin(), line.x.end());
      for (size_t i = 0; i < trial.size(); ++i) trial[i] += alpha * line.d[i];
      if (line.E.value(trial) <= line.value.value + 0.1 * alpha * line.slope) return alpha;
    }
    return 0.0;
  };
  const MinimizeReport report = Minimizer().minimize(f, *newton_with(), x, options, [](const LiveIteration& iteration) {
    if (iteration.alpha > 0) {
      EXPECT_EQ(iteration.tried.size(), 1u);
    }
  });
  EXPECT_TRUE(is_success(report.status));
  EXPECT_NEAR(x[0], 1, 1e-8);
}

TEST(LineSearch, CustomSearchWithoutAStepIsStuck) {
  for (const double alpha : {0.0, -1.0, std::nan("")}) {
    Rosenbrock f;
    std::vector<double> x = {-0.8, 0.6, 0};
    MinimizeOptions options = tight();
    options.line_search.custom = [&](const SearchLine&) { return alpha; };
    EXPECT_EQ(Minimizer().minimize(f, *newton_with(), x, options).status, Status::stuck);
    EXPECT_EQ(x[0], -0.8);
  }
}

TEST(LineSearch, DescendsBelowRoundOffOfValues) {
  OffsetParabola f;
  GradientDescent direction;
  std::vector<double> x = {1.3};
  MinimizeOptions options = tight();
  options.max_iterations = 1000;
  const MinimizeReport report = Minimizer().minimize(f, direction, x, options);
  EXPECT_EQ(report.status, Status::converged);
  EXPECT_LT(std::abs(x[0]), 1e-11);
}

// f(x, y) = (x^2 - 1)^2 / 4 + y^2 / 2 has a saddle at (0, 0), where gradients and directions are short.
class TwoWells : public PlanarFunction {
 public:
  double at(const Planar& p) const override { return std::pow(p[0] * p[0] - 1, 2) / 4 + p[1] * p[1] / 2; }
  Planar gradient_at(const Planar& p) const override { return {p[0] * (p[0] * p[0] - 1), p[1]}; }
  PlanarHessian hessian_at(const Planar& p) const override { return {3 * p[0] * p[0] - 1, 0, 1}; }
};

TEST(Minimize, ShortDirectionNearSaddleIsNotConvergence) {
  for (const bool truncated : {false, true}) {
    TwoWells f;
    const auto direction = truncated ? make_newton_cg() : newton_with(NewtonDefiniteness::on_demand);
    std::vector<double> x = {1e-12, 0, 0};
    MinimizeOptions options;
    options.criterion = Criterion::velocity;
    options.tolerance = 1e-6;
    options.max_iterations = 500;
    const MinimizeReport report = Minimizer().minimize(f, *direction, x, options);
    EXPECT_TRUE(is_success(report.status)) << to_string(report.status);
    EXPECT_NEAR(std::abs(x[0]), 1, 1e-6) << truncated;
  }
}

// A function whose evaluations advance a clock.
class Timed : public Rosenbrock {
 public:
  Evaluation evaluate(std::span<const double> x) override { return ++time, Rosenbrock::evaluate(x); }
  void gradient(std::span<const double> x, std::span<double> g) override { ++time, Rosenbrock::gradient(x, g); }
  const BlockSparse& evaluate_hessian(std::span<const double> x, const Projection& projection) override {
    return ++time, Rosenbrock::evaluate_hessian(x, projection);
  }
  double time = 0;
};

TEST(Minimize, StopsAtDeadline) {
  bool ended_in_line_search = false;
  for (double seconds = 1; seconds < 100; ++seconds) {
    Timed f;
    const WallClock clock = [&f] { return f.time; };
    std::vector<double> x = {-1.5, 0.6, 0};
    const double start = f.at({x[0], x[1]});
    MinimizeOptions options = tight();
    options.stop = StopToken(clock, seconds);
    double last_alpha = 1;
    int last_trials = 0;
    const MinimizeReport report = Minimizer().minimize(f, *newton_with(), x, options, [&](const Iteration& iteration) {
      last_alpha = iteration.alpha;
      last_trials = iteration.trials;
    });
    EXPECT_LE(f.at({x[0], x[1]}), start);
    EXPECT_EQ(report.value, f.at({x[0], x[1]}));
    ended_in_line_search = ended_in_line_search || (last_alpha == 0 && last_trials > 0);
    if (report.status == Status::converged) {
      EXPECT_GT(seconds, 10);
      EXPECT_TRUE(ended_in_line_search);
      return;
    }
    EXPECT_EQ(report.status, Status::budget);
    EXPECT_FALSE(is_success(report.status));
    EXPECT_LE(f.time, seconds + 2);
  }
  ADD_FAILURE() << "never converged";
}

TEST(LineSearch, AscentDirectionIsStuck) {
  Rosenbrock f;
  const std::vector<double> x = {0, 0, 0}, d = {-1, 0, 0};
  LineSearchScratch scratch{std::vector<double>(3), std::vector<double>(3), {}};
  EXPECT_EQ(backtrack({f, x, d, {f.value(x)}, -2}, {}, scratch).alpha, 0);
}

}  // namespace
}  // namespace aspic
