#include "estimate/fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "base/check.h"
#include "base/error.h"
#include "estimate/fit_run.h"
#include "model/limits.h"

namespace aspic {
namespace {

struct NamedMethod {
  const char* name;
  FitMethod method;
};
constexpr NamedMethod kMethods[] = {{"levenberg_marquardt", levenberg_marquardt}, {"gauss_newton_cg", gauss_newton_cg}};

using WeightRule = Status (*)(FitRun&, FitPoint&, FitGoal&, FitMethod);

Status fit_with_weight(FitRun& run, FitPoint& at, FitGoal& goal, FitMethod method) { return method(run, at, goal); }

struct NamedRule {
  const char* name;
  WeightRule rule;
};
constexpr NamedRule kRules[] = {
    {"prior", fit_with_weight}, {"discrepancy", fit_by_discrepancy}, {"evidence", fit_by_evidence}};

template <class Named>
const Named& named(std::span<const Named> all, const std::string& what, const std::string& name) {
  std::vector<std::string> known{"auto"};
  for (const Named& each : all) {
    if (name == each.name) return each;
    known.emplace_back(each.name);
  }
  throw InvalidInput(what + " '" + name + "' is unknown" + suggestion(name, known));
}

void check(const FitOptions& o) {
  const auto positive = [](double x, const char* what) {
    if (!(x > 0)) throw InvalidInput(std::string(what) + " of a fit must be positive");
  };
  positive(o.tolerance, "the tolerance");
  positive(o.max_step, "the largest step");
  positive(o.starts, "the number of starts");
  positive(o.max_inner, "the number of inner iterations");
  if (std::isnan(o.weight) || std::isinf(o.weight)) throw InvalidInput("the weight of a fit must be finite");
}

// Moves away from the guess along a smooth random direction drawn from the prior.
std::vector<double> scattered(FitRun& run, std::span<const double> guess, int start) {
  std::vector<double> p(guess.begin(), guess.end());
  if (start == 0) return p;
  std::mt19937_64 random(static_cast<uint64_t>(start));
  std::vector<double> v(p.size()), d(p.size());
  for (double& vi : v)  // sums of uniform numbers, which are equal for every standard library
    for (int k = 0; k < 4; ++k) vi += static_cast<double>(random() >> 11) * 0x1p-53 - 0.5;
  run.solve_prior(guess, v, d);
  const double size = max_abs(d);
  if (size > 0) add_scaled(run.options.scatter / size, d, p);
  return p;
}

std::string ending(Status status) {
  switch (status) {
    case Status::converged:
      return "converged";
    case Status::round_off:
      return "converged to the accuracy of the equilibria";
    case Status::iteration_limit:
      return "stopped at the maximum number of iterations: not converged";
    case Status::interrupted:
      return "stopped on request: not converged";
    case Status::budget:
      return "stopped at the time limit: not converged";
    case Status::undefined:
      return "the model or its Jacobian could not be evaluated";
    case Status::no_descent:
      return "no direction improves the fit";
    default:
      return "stuck: no step improves the fit";
  }
}

// State that depends on the initial guess.
struct Attempt {
  Status status = Status::undefined;
  FitPoint point;
  double weight = 0, objective = std::numeric_limits<double>::quiet_NaN();
  std::string message;
};

bool is_better(const Attempt& a, const Attempt& b) {
  if (std::isnan(a.objective) || std::isnan(b.objective)) return !std::isnan(a.objective);
  return a.objective < b.objective;
}

}  // namespace

std::vector<std::string> fit_method_names() {
  std::vector<std::string> names{"auto"};
  for (const NamedMethod& m : kMethods) names.emplace_back(m.name);
  return names;
}

std::vector<std::string> weight_rule_names() {
  std::vector<std::string> names{"auto"};
  for (const NamedRule& r : kRules) names.emplace_back(r.name);
  return names;
}

FitReport fit(LeastSquares& misfit, Regularizer& regularizer, std::span<const double> guess, const FitOptions& options,
              const FitObserver& observe) {
  ASPIC_CHECK(static_cast<int>(guess.size()) == misfit.parameter_count());
  check(options);
  const bool few = misfit.parameter_count() <= kFewParameters;
  const NamedMethod method =
      options.method == "auto" ? kMethods[few ? 0 : 1] : named<NamedMethod>(kMethods, "method", options.method);
  const NamedRule rule = options.weight_rule == "auto" ? kRules[few ? 0 : 1]
                                                       : named<NamedRule>(kRules, "weight rule", options.weight_rule);
  const bool is_quadratic = method.method == levenberg_marquardt;  // quadratic convergence makes the last digits cheap
  FitRun run(misfit, regularizer, options, observe);
  run.weight = options.weight >= 0 ? options.weight : 1;

  Attempt best;
  WeightRule choose = options.weight >= 0 ? fit_with_weight : rule.rule;
  for (int start = 0; start < options.starts; ++start) {
    Attempt now;
    run.start = start;
    run.report.message.clear();
    FitGoal goal{.tolerance = options.tolerance, .enough = is_quadratic ? 0 : options.enough};
    if (run.evaluate(scattered(run, guess, start), now.point)) {
      now.status = choose(run, now.point, goal, method.method);
      now.objective = now.point.objective(run.weight);
      choose = fit_with_weight;  // weights must be equal for comparison
    }
    now.message = run.report.message;
    now.weight = run.weight;
    run.report.starts.push_back(now.objective);
    if (start == 0 || is_better(now, best)) best = std::move(now);
    if (best.status == Status::interrupted || run.is_stopped()) break;
  }

  FitReport report = std::move(run.report);
  report.status = best.status;
  report.p = best.point.p;
  report.weight = best.weight;
  report.misfit = best.point.misfit;
  report.roughness = best.point.roughness;
  report.method = method.name;
  report.iterations = static_cast<int>(report.history.size());
  report.message = ending(best.status) + (best.message.empty() ? "" : "; " + best.message);
  std::sort(report.weights.begin(), report.weights.end(),
            [](const WeightTrial& a, const WeightTrial& b) { return a.weight < b.weight; });
  std::vector<double> r(best.point.r.size());
  if (!report.p.empty() && std::isfinite(best.objective) && !misfit.evaluate(report.p, r)) {
    report.status = Status::undefined;
    report.message = "the model could not be evaluated again at the end of the fit";
  }
  return report;
}

}  // namespace aspic
