// Selects the weight of the prior from the data [Morozov 1966; MacKay 1992]: fits with a sequence of
// weights, each starting from the last.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/formatted.h"
#include "estimate/evidence.h"
#include "estimate/fit_run.h"
#include "model/limits.h"

namespace aspic {
namespace {

constexpr double kLargestFall = 1.0 / 30;  // decrease of the weight between trials, which start from the last one
// Change of log |r|^2 per factor e of the weight. Chosen: judge() expects 0.1 to 1.
constexpr double kStagnation = 0.02;
// Between the first weight and the last: a million times in standard deviations of the prior.
constexpr double kRange = 1e12;
constexpr int kBestSeen = 64;           // directions used to select the weight: relative error sqrt(2 / 64) = 0.18
constexpr double kSettledWeight = 0.3;  // change of the log weight of largest evidence, less than twice this error

// Weight at which prior and data have equal slopes along the steepest descent in the norm of the prior.
std::optional<double> balanced_weight(FitRun& run, const FitPoint& at) {
  if (!run.linearize(at)) return {};
  std::vector<double> g(at.p.size()), d(g.size()), Rd(g.size(), 0.0), Jd(at.r.size());
  run.multiply_transposed(at.r, g);
  if (max_abs(g) == 0) return 1;
  run.solve_prior(at.p, g, d);
  run.multiply(d, Jd);
  run.add_prior_product(at, d, 1, Rd);
  const double weight = dot(Jd, Jd) / dot(d, Rd);
  if (!(weight > 0) || !std::isfinite(weight)) return {};
  return weight;
}

// Far above the number of residuals one step suffices for |r|^2; near it, accuracy must be within its scatter.
constexpr double kFar = 0.5;  // distance of log (|r|^2 / number)

double log_ratio(const FitRun& run, double misfit) { return std::log(std::max(2 * misfit / run.readings(), 1e-300)); }
double scatter(const FitRun& run) { return std::sqrt(0.5 * std::sqrt(2.0 * run.readings())); }

Status fit_loosely(FitRun& run, FitPoint& at, FitGoal& goal, FitMethod method) {
  FitGoal loose = goal;
  loose.is_new = true;
  const bool was_far = log_ratio(run, at.misfit) > kFar;
  loose.enough = was_far ? std::numeric_limits<double>::infinity() : std::max(goal.enough, scatter(run));
  Status status = method(run, at, loose);
  if (was_far && is_success(status) && log_ratio(run, at.misfit) <= kFar) {
    loose.enough = std::max(goal.enough, scatter(run));
    status = method(run, at, loose);
  }
  goal.first_decrement = loose.first_decrement;
  return status;
}

WeightTrial trial_at(const FitRun& run, const FitPoint& at) { return {run.weight, at.misfit, at.roughness, at.p}; }

bool go_to(FitRun& run, FitPoint& at, const WeightTrial& trial) {
  run.weight = trial.weight;
  return at.p == trial.p || run.evaluate(trial.p, at);
}

// Finds the weight with |r|^2 = number of residuals from the trials.
class Discrepancy {
 public:
  explicit Discrepancy(int residuals)
      : count_(residuals), slack_(std::log1p(std::clamp(std::sqrt(2.0 / residuals), 0.02, 0.3))) {}

  enum class Verdict { fits, try_on, unexplained, explained_by_guess };
  Verdict judge(double weight, double misfit) {
    const Known now{std::log(weight), std::log(std::max(2 * misfit / count_, 1e-300))};
    if (!first_) first_ = now;
    const std::optional<Known> before = last_;
    last_ = now;
    if (std::abs(now.y) <= slack_) return Verdict::fits;
    (now.y > 0 ? too_large_ : too_small_) = now;
    if (too_large_ && too_small_) {
      if (std::abs(too_large_->w - too_small_->w) < 0.02) return Verdict::fits;
      // Regula falsi, away from the ends.
      const double part = std::clamp(too_large_->y / (too_large_->y - too_small_->y), 0.1, 0.9);
      next_ = too_large_->w + part * (too_small_->w - too_large_->w);
      return Verdict::try_on;
    }
    if (std::abs(now.w - first_->w) > std::log(kRange))
      return now.y > 0 ? Verdict::unexplained : Verdict::explained_by_guess;
    const double moved = before ? now.w - before->w : 0;
    const double slope = moved != 0 ? (now.y - before->y) / moved : 0.5;
    if (moved < 0 && now.y > 0 && slope < kStagnation && now.y < 2) return Verdict::unexplained;
    next_ = now.w - std::copysign(std::clamp(std::abs(now.y) / std::clamp(slope, 0.1, 1.0), std::log(2.0),
                                             -std::log(kLargestFall)),
                                  now.y);
    return Verdict::try_on;
  }
  bool is_met(double misfit) const { return std::abs(std::log(std::max(2 * misfit / count_, 1e-300))) <= slack_; }
  double next() const { return std::exp(next_); }

 private:
  struct Known {
    double w, y;  // log weight, log (|r|^2 / count)
  };
  int count_;
  double slack_, next_ = 0;
  std::optional<Known> first_, last_, too_large_, too_small_;
};

// Largest weight whose fit is about as good as the best.
const WeightTrial& most_cautious(const std::vector<WeightTrial>& trials) {
  const auto less = [](const WeightTrial& a, const WeightTrial& b) { return a.misfit < b.misfit; };
  const double best = std::min_element(trials.begin(), trials.end(), less)->misfit;
  const WeightTrial* chosen = nullptr;
  for (const WeightTrial& t : trials)
    if (t.misfit <= 1.1 * best && (!chosen || t.weight > chosen->weight)) chosen = &t;
  return *chosen;
}

std::string describe(Discrepancy::Verdict verdict, double squares, int residuals) {
  const std::string found = "|r|^2 = " + three_digits(squares) + " of " + std::to_string(residuals) + " residuals";
  if (verdict == Discrepancy::Verdict::fits) return "the weight leaves " + found;
  if (verdict == Discrepancy::Verdict::explained_by_guess)
    return "the guess already explains the data within their standard deviations (" + found +
           "): they may be too large";
  return "no material of this model explains the data within their standard deviations (" + found +
         "): they may be too small, or the model may be wrong";
}

}  // namespace

Status fit_by_discrepancy(FitRun& run, FitPoint& at, FitGoal& goal, FitMethod method) {
  const std::optional<double> balanced = balanced_weight(run, at);
  if (!balanced) return Status::undefined;
  run.weight = run.options.first_weight > 0 ? run.options.first_weight : 0.1 * *balanced;
  Discrepancy rule(run.readings());
  std::vector<WeightTrial>& trials = run.report.weights;
  auto verdict = Discrepancy::Verdict::try_on;
  while (verdict == Discrepancy::Verdict::try_on) {  // each trial moves the weight, or shortens the bracket by a tenth
    const Status status = fit_loosely(run, at, goal, method);
    if (!is_success(status)) return status;
    trials.push_back(trial_at(run, at));
    verdict = rule.judge(run.weight, at.misfit);
    if (verdict == Discrepancy::Verdict::try_on) run.weight = rule.next();
  }
  if (verdict == Discrepancy::Verdict::unexplained && !go_to(run, at, most_cautious(trials))) return Status::undefined;
  const Status status = method(run, at, goal);
  if (rule.is_met(at.misfit)) verdict = Discrepancy::Verdict::fits;
  run.report.message = describe(verdict, 2 * at.misfit, run.readings());
  return status;
}

Status fit_by_evidence(FitRun& run, FitPoint& at, FitGoal& goal, FitMethod method) {
  const std::optional<double> balanced = balanced_weight(run, at);
  if (!balanced) return Status::undefined;
  run.weight = run.options.first_weight > 0 ? run.options.first_weight : 0.1 * *balanced;
  run.report.message = "the search for the weight of largest evidence did not converge";
  for (int i = 0; i < kFixedPointPasses; ++i) {
    if (const Status status = fit_loosely(run, at, goal, method); !is_success(status)) return status;
    run.report.weights.push_back(trial_at(run, at));
    if (!run.linearize(at)) return Status::undefined;
    PriorGaussian before(run.prior(), run.weight, at.p);
    const Spectrum s = spectrum(run.data(), before, {.dense = kBestSeen, .max_rank = kBestSeen, .negligible = 1});
    if (!s.ok) return Status::undefined;
    const double factor = supported_weight(run.prior(), run.weight, at.p, s).factor;
    if (std::abs(std::log(factor)) < kSettledWeight) {
      run.report.message = "the weight maximizes the evidence of the data";
      break;
    }
    run.weight *= std::clamp(factor, kLargestFall, 1 / kLargestFall);
  }
  return method(run, at, goal);
}

}  // namespace aspic
