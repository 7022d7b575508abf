#include "estimate/fit_run.h"

#include <algorithm>
#include <cmath>

namespace aspic {
namespace {

constexpr double kNoise = 1e-10;              // of |r|^2, relative: equilibria have residual forces of 1e-9
constexpr double kSufficientDecrease = 1e-4;  // [Nocedal and Wright 2006, section 3.1]
constexpr double kShortest = 1e-6;            // step: 20 halvings. Chosen

bool is_finite(std::span<const double> v) {
  return std::all_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); });
}

}  // namespace

bool FitRun::evaluate(std::span<const double> p, FitPoint& point) {
  point.p.assign(p.begin(), p.end());
  point.r.resize(static_cast<size_t>(residuals()));
  ++report.evaluations;
  if (!is_finite(p) || !data_.evaluate(p, point.r)) return false;
  evaluated_ = point.p;
  point.misfit = dot(point.r, point.r) / 2;
  point.roughness = regularizer_.value(p);
  return std::isfinite(point.misfit) && std::isfinite(point.roughness);
}

bool FitRun::linearize(const FitPoint& at) {
  if (at.p != evaluated_) {  // another trial was evaluated since
    FitPoint again;
    if (!evaluate(at.p, again)) return false;
  }
  return data_.linearize();
}

void FitRun::multiply(std::span<const double> dp, std::span<double> dr) {
  ++report.products;
  data_.multiply(dp, dr);
}

void FitRun::multiply_transposed(std::span<const double> w, std::span<double> pbar) {
  ++report.products;
  data_.multiply_transposed(w, pbar);
}

void FitRun::gradient(const FitPoint& at, std::span<double> g) {
  multiply_transposed(at.r, g);
  regularizer_.add_gradient(at.p, weight, g);
}

void FitRun::add_prior_product(const FitPoint& at, std::span<const double> v, double scale, std::span<double> y) const {
  regularizer_.add_hessian_product(at.p, v, scale, y);
}

void FitRun::multiply_curvature(const FitPoint& at, std::span<const double> v, std::span<double> y) {
  dr_.resize(static_cast<size_t>(residuals()));
  multiply(v, dr_);
  multiply_transposed(dr_, y);
  add_prior_product(at, v, weight, y);
}

void FitRun::solve_prior(std::span<const double> p, std::span<const double> v, std::span<double> z) {
  regularizer_.solve(p, v, 0, z);
}

void FitRun::note(FitIteration iteration, const FitPoint& at) {
  iteration.index = static_cast<int>(report.history.size());
  iteration.start = start;
  iteration.weight = weight;
  iteration.misfit = at.misfit;
  iteration.roughness = at.roughness;
  iteration.objective = at.objective(weight);
  report.history.push_back(iteration);
  if (observe_) observe_(iteration, at.p);
}

bool is_lost_in_noise(double decrement, double objective) {
  return decrement * decrement / 2 <= kNoise * std::abs(objective);
}

bool search_along(FitRun& run, FitPoint& at, std::span<const double> d, double slope, FitStep& step) {
  const double before = at.objective(run.weight), noise = kNoise * std::abs(before);
  step.length = std::min(1.0, run.options.max_step / max_abs(d));
  FitPoint trial;
  std::vector<double> p(at.p.size());
  for (; step.length > kShortest && !run.is_stopped(); step.length *= 0.5) {
    for (size_t i = 0; i < p.size(); ++i) p[i] = at.p[i] + step.length * d[i];
    ++step.trials;
    if (!run.evaluate(p, trial)) {
      step.length *= 0.5;  // smaller steps near the boundary of the domain
      continue;
    }
    if (trial.objective(run.weight) <= before + kSufficientDecrease * step.length * slope + noise) {
      std::swap(at, trial);
      return true;
    }
  }
  step.length = 0;
  return false;
}

}  // namespace aspic
