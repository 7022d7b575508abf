#include "estimate/motion_fit.h"

#include <algorithm>
#include <cmath>

#include "model/limits.h"
#include "model/scaled_inverse.h"
#include "optimize/lbfgs.h"

namespace aspic {
namespace {

// Minimum number per preconditioner, which costs as many simulations as parameters. Chosen.
constexpr int kIterations = 4;
// Largest predicted decrease at the solution, relative to the value without any motion and, for noisy data, to the
// value per degree of freedom: a twentieth of a standard deviation.
constexpr double kDecrease = kStagnated * kStagnated, kDecreaseInNoise = 1e-3;
// The same if the line search found no step: a seventh of a standard deviation.
constexpr double kRoundOff = kSame * kSame, kRoundOffInNoise = 1e-2;
// Eigenvalue of the scaled Hessian, whose central differences have errors of 1e-6, below which a direction is not
// determined.
constexpr double kWeakest = 1e-5;
constexpr double kVanished = -5;  // p of a damping coefficient that has fallen to 0.7 % of its guess. Chosen

double redundancy(const MotionObjective& f) {  // degrees of freedom
  return 3.0 * static_cast<double>(f.data().samples.size()) - f.parameters().size();
}

class MotionMinimizer {
 public:
  MotionMinimizer(MotionObjective& objective, const MotionFitOptions& options, MotionFitReport& report)
      : f_(objective), options_(options), report_(report) {}

  // Rounds of L-BFGS, each with a new preconditioner, until a round finds the iterate minimal without leaving it.
  void run() {
    while (report_.iterations < options_.max_iterations) {
      f_.linearize(f_.iterate());
      if (is_stopped()) return;
      report_.status = minimize();
      if (is_stopped()) return;
      if (iterations_of_round_ <= 1 && report_.status != Status::iteration_limit) return;
    }
    report_.status = Status::iteration_limit;
  }

 private:
  bool is_stopped() {
    report_.stopped = f_.stop().stopped();
    if (report_.stopped) report_.status = f_.stop().requested() ? Status::interrupted : Status::budget;
    return report_.stopped;
  }

  double tolerance(double relative, double in_noise) const {
    return std::max(relative * f_.resting_value(), in_noise * f_.iterate().value / std::max(redundancy(f_), 1.0));
  }

  Status minimize() {
    LBFGS direction{Preconditioner(PreconditionerKind::own)};
    Minimizer minimizer;
    std::vector<double> x(3 * static_cast<size_t>(f_.block_rows()), 0.0);
    std::copy(f_.iterate().p.begin(), f_.iterate().p.end(), x.begin());
    bool is_done = false;
    iterations_of_round_ = 0;
    const auto observe = [&](const LiveIteration& iteration) {
      ++iterations_of_round_;
      ++report_.iterations;
      // The prediction is good in the first iteration of a round. Later ones may be small by chance.
      is_done = iteration.decrement <= (iterations_of_round_ == 1 ? 1 : 0.01) * tolerance(kDecrease, kDecreaseInNoise);
      if (options_.observe) options_.observe({report_.iterations, f_.iterate().rms, f_.simulations()});
    };
    const int left =
        std::min(std::max(kIterations, f_.parameters().size()), options_.max_iterations - report_.iterations);
    const MinimizeOptions options{.max_iterations = left,
                                  .tolerance = 0,
                                  .criterion = Criterion::first_gradient,
                                  .line_search = {.tolerance = 1e-6},
                                  .stop = StopToken([&] { return is_done || f_.stop().stopped(); })};
    const MinimizeReport found = minimizer.minimize(f_, direction, {x, f_.at_iterate()}, options, observe);
    if (is_done || is_success(found.status)) return Status::converged;
    if (found.status == Status::stuck && found.decrement <= tolerance(kRoundOff, kRoundOffInNoise))
      return Status::converged;
    return found.status;
  }

  MotionObjective& f_;
  const MotionFitOptions& options_;
  MotionFitReport& report_;
  int iterations_of_round_ = 0;
};

// The Hessian by central differences of the gradient, n x n. Columns of parameters whose neighbors cannot be simulated
// are 0.
std::vector<double> hessian(MotionObjective& f, const MotionPoint& at) {
  const int n = f.parameters().size();
  std::vector<double> H(static_cast<size_t>(n) * n, 0.0);
  for (int i = 0; i < n && !f.stop().stopped(); ++i) {
    std::vector<double> p = at.p;
    p[i] = at.p[i] + kCentralStep;
    const MotionPoint ahead = f.differentiate(p);
    p[i] = at.p[i] - kCentralStep;
    const MotionPoint behind = f.differentiate(p);
    for (int j = 0; j < n && ahead.ok && behind.ok; ++j) {
      const double slope = (ahead.gradient[j] - behind.gradient[j]) / (2 * kCentralStep);
      H[static_cast<size_t>(n) * i + j] += slope / 2, H[static_cast<size_t>(n) * j + i] += slope / 2;
    }
  }
  return H;
}

// Standard deviation of the residuals in units of sigma; infinite if it is neither stated nor estimated from redundant
// data. A stated sigma is a lower bound, because errors of the model add to the noise.
double noise(const MotionObjective& f, const MotionPoint& at) {
  const double estimate = redundancy(f) > 0 ? std::sqrt(2 * at.value / redundancy(f)) : INFINITY;
  if (!f.data().has_sigma) return estimate;
  return std::isfinite(estimate) ? std::max(1.0, estimate) : 1;
}

void find_sigmas(MotionObjective& f, MotionFitReport& report) {
  const int n = f.parameters().size();
  std::vector<double> H = hessian(f, report.after);
  const double least = std::pow(kSame, 2) * 2 * f.resting_value();
  for (int i = 0; i < n; ++i)
    if (f.is_held(i) || !(H[static_cast<size_t>(n) * i + i] > least))
      for (int j = 0; j < n; ++j) H[static_cast<size_t>(n) * i + j] = H[static_cast<size_t>(n) * j + i] = 0;
  const ScaledInverse covariance = scaled_inverse(n, H, kWeakest, Weak::raised);
  const double s = noise(f, report.after);
  for (int i = 0; i < n; ++i) {
    FittedMotionValue& value = report.values[i];
    const double sigma = s * std::sqrt(covariance.inverse[static_cast<size_t>(n) * i + i]);
    if (!(H[static_cast<size_t>(n) * i + i] > 0))
      value.message = "the motion does not depend on it";
    else if (covariance.weakest[i] < kWeakest)
      value.message = "only determined together with another parameter";
    else if (!(sigma < kLinearRange))
      value.message = "the noise is too large";
    else
      value.sigma = std::abs(f.parameters().slope(i, report.p[i])) * sigma;
  }
}

}  // namespace

MotionFitReport fit_motion(MotionObjective& objective, const MotionFitOptions& options) {
  const MotionParameters& parameters = objective.parameters();
  MotionFitReport report;
  report.p.assign(parameters.size(), 0.0);
  report.before = objective.differentiate(report.p);
  report.after = report.before;
  if (report.before.ok) {
    objective.set_iterate(report.before);
    MotionMinimizer(objective, options, report).run();
    report.after = objective.iterate();
    report.p = report.after.p;
  } else {
    report.stopped = objective.stop().stopped();
    report.message = report.stopped ? "stopped before the first simulation ended" : report.before.message;
  }
  for (int i = 0; i < parameters.size(); ++i)
    report.values.push_back({parameters.parameters()[i], parameters.value(i, report.p[i]), INFINITY, {}});
  if (is_success(report.status)) {
    find_sigmas(objective, report);
    report.stopped = objective.stop().stopped();
  }
  if (!is_success(report.status) || report.stopped)
    for (FittedMotionValue& value : report.values) value.sigma = INFINITY, value.message = "the fit has not converged";
  for (int i = 0; i < parameters.size(); ++i)
    if (report.values[i].parameter.can_vanish && report.p[i] < kVanished && std::isinf(report.values[i].sigma))
      report.values[i].message = "it tends to 0; fit without it";
  report.chi_squared = redundancy(objective) > 0 ? 2 * report.after.value / redundancy(objective) : 0;
  report.simulations = objective.simulations();
  report.gradients = objective.gradients();
  return report;
}

}  // namespace aspic
