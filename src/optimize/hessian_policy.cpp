#include "optimize/hessian_policy.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "math/vectors.h"

namespace aspic {
namespace {

constexpr double kTighten = 0.5, kRelax = 2;  // as in [Fernandez-Fernandez et al. 2026]
constexpr double kAll = 1e-6;                 // fraction of the largest residual below which all elements are selected

double residual(std::span<const double> g, size_t vertex) {
  return std::max({std::abs(g[3 * vertex]), std::abs(g[3 * vertex + 1]), std::abs(g[3 * vertex + 2])});
}

class FixedHessian : public HessianPolicy {
 public:
  explicit FixedHessian(Definiteness kind) : kind_(kind) {}
  bool compute(NewtonSystem& system, NewtonTask& task) override { return system.solve(task, {kind_}); }

 private:
  Definiteness kind_;
};

class ProgressiveHessian : public HessianPolicy {
 public:
  void begin() override {
    tighten_next_ = false;
    projection_.begin();
  }

  bool compute(NewtonSystem& system, NewtonTask& task) override {
    // Relaxes only after a successful direction; otherwise fallbacks would never end.
    std::exchange(tighten_next_, false) ? projection_.tighten(task.g) : projection_.relax();
    for (;; projection_.tighten(task.g)) {
      const Projection projection = projection_.at(task.g);
      task.report.projected = task.report.projected || projection.kind != Definiteness::exact;
      if (system.solve(task, projection)) return true;
      if (projection_.is_complete() || system.is_late(task.report)) return false;
    }
  }

  bool fall_back() override { return tighten_next_ = !projection_.is_complete(); }

 private:
  ProgressiveProjection projection_;
  bool tighten_next_ = false;
};

class HessianOnDemand : public HessianPolicy {
 public:
  void begin() override {
    skip_exact_ = is_modified_ = clamps_stencils_ = false;
    absolute_left_ = 0;
    absolute_span_ = kAbsoluteSpan;
    modified_in_a_row_ = 0;
  }

  bool compute(NewtonSystem& system, NewtonTask& task) override {
    const bool waits = modified_in_a_row_ > kModifiedBeforeTruncated && modified_in_a_row_ % kExactEvery != 0;
    is_modified_ = std::exchange(skip_exact_, false) || waits;
    if (!is_modified_ && solve_exact(system, task)) {
      modified_in_a_row_ = 0;
      return true;
    }
    if (system.is_late(task.report)) return false;
    const double gained = task.value ? last_value_ - *task.value : 0;
    if (task.value) last_value_ = *task.value;
    const bool creeps = task.value && !is_modified_ && modified_in_a_row_ >= kModifiedBeforeTruncated;
    ++modified_in_a_row_;
    if (creeps && leaves_saddle(system, task, gained)) return true;
    if (system.is_late(task.report)) return false;
    is_modified_ = task.report.projected = true;
    return solve_modified(system, task);
  }

  bool fall_back() override { return skip_exact_ = !is_modified_; }

 private:
  static constexpr int kAbsoluteSpan = 8;  // number of directions; doubles after each overshoot
  static constexpr int kModifiedBeforeTruncated =
      2;  // successive directions of modified Hessians before truncated ones

  // After several modified Hessians in a row, the exact one is tried every fourth time. The first five steps of cloth
  // that falls on a sphere (10 300 vertices) take 40 s instead of 56.
  static constexpr int kExactEvery = 4;

  // Contact forces bend around small gaps, which makes Hessians indefinite where bodies are not. To clamp contact is
  // then enough, also for the rest of the minimization.
  bool solve_exact(NewtonSystem& system, NewtonTask& task) {
    if (!clamps_stencils_ && system.solve(task, {Definiteness::exact})) return true;
    if (!system.has_stencils() || system.is_late(task.report)) return false;
    clamps_stencils_ = true;
    return system.solve(task, {.clamps_stencils = true});
  }

  // Modified Hessians are too stiff near a saddle, so iterates leave it slowly. Uses a truncated direction of the exact
  // Hessian if it decreases E as much as the last step did.
  bool leaves_saddle(NewtonSystem& system, NewtonTask& task, double gained) {
    if (!system.solve_truncated(task)) return false;
    return task.report.truncated = *task.value - lengthen(task) >= gained;
  }

  // In inverted or strongly compressed elements, negative eigenvalues are as large as positive ones. Clamping them
  // yields directions that are too long; absolute values shorten them [Chen2024Filtering]. In other elements, absolute
  // values are too stiff.
  bool solve_modified(NewtonSystem& system, NewtonTask& task) {
    const auto is_unjudged = [&] { return !task.value || system.is_late(task.report); };
    if (absolute_left_ == 0) {
      if (!system.solve(task, {Definiteness::clamped})) return false;
      if (is_unjudged() || lengthen(task) <= *task.value) return true;
      absolute_left_ = absolute_span_;
      absolute_span_ *= 2;
    }
    --absolute_left_;
    if (!system.solve(task, {Definiteness::absolute})) return false;
    if (!is_unjudged()) lengthen(task);
    return true;
  }

  // Doubles d while E decreases, the step remains feasible, and the parabola through E at both ends of d has its
  // minimum beyond 2 d. Returns E at x + d, or at the largest feasible step along d.
  double lengthen(NewtonTask& task) {
    double end = value_ahead(task, task.d, std::min(1.0, task.E.max_step(task.x, task.d)));
    double slope = task.E.dot(task.g, task.d), size = 0;
    for (const double di : task.d) size = std::max(size, std::abs(di));
    size = task.E.largest(size);
    for (double length = 2; 4 * (end - *task.value - slope) < -slope; length *= 2, slope *= 2) {
      if (length * size > task.E.scales().x) break;
      twice_.assign(task.d.begin(), task.d.end());
      for (double& di : twice_) di *= 2;
      if (task.E.max_step(task.x, twice_) < 1) break;  // the bounds of contact are at most 1
      const double further = value_ahead(task, twice_, 1);
      if (!(further < end)) break;
      std::copy(twice_.begin(), twice_.end(), task.d.begin());
      end = further;
    }
    return end;
  }

  // Returns E at x + alpha d.
  double value_ahead(NewtonTask& task, std::span<const double> d, double alpha) {
    ahead_.resize(task.x.size());
    for (size_t i = 0; i < ahead_.size(); ++i) ahead_[i] = task.x[i] + alpha * d[i];
    ++task.report.values;
    return task.E.value(ahead_);
  }

  bool skip_exact_ = false;  // for the next direction, after a fallback
  bool clamps_stencils_ = false;
  bool is_modified_ = false;   // whether the last direction used a modified Hessian
  int absolute_left_ = 0;      // number of upcoming modified Hessians that use absolute eigenvalues
  int absolute_span_ = 0;      // next value of absolute_left_ after an overshoot
  int modified_in_a_row_ = 0;  // successive directions of modified Hessians
  double last_value_ = 0;      // E at the last iterate with such a direction
  std::vector<double> ahead_, twice_;
};

}  // namespace

Projection ProgressiveProjection::at(std::span<const double> g) {
  covers_all_ = false;
  if (threshold_ == kNone) return {};
  const double largest = max_abs(g);
  covers_all_ = threshold_ < kAll * largest;
  if (covers_all_) return {Definiteness::clamped};
  if (threshold_ >= largest) return {};
  marked_.resize(g.size() / 3);
  for (size_t v = 0; v < marked_.size(); ++v) marked_[v] = residual(g, v) > threshold_;
  return {Definiteness::clamped, marked_};
}

// The threshold is always below the largest residual, so that the selection grows.
void ProgressiveProjection::tighten(std::span<const double> g) {
  const double largest = max_abs(g);
  threshold_ = kTighten * (threshold_ == kNone ? largest : std::min(threshold_, largest));
}

void ProgressiveProjection::relax() {
  if (threshold_ != kNone) threshold_ *= kRelax;
}

// In the order of NewtonDefiniteness.
constexpr std::string_view kNewtonDefinitenessNames[] = {"exact", "clamped", "absolute", "on_demand", "progressive"};

std::string_view to_string(NewtonDefiniteness definiteness) {
  return kNewtonDefinitenessNames[static_cast<size_t>(definiteness)];
}

std::vector<NewtonDefiniteness> all_definiteness() {
  return {NewtonDefiniteness::on_demand, NewtonDefiniteness::progressive, NewtonDefiniteness::clamped,
          NewtonDefiniteness::absolute, NewtonDefiniteness::exact};
}

std::unique_ptr<HessianPolicy> make_hessian_policy(NewtonDefiniteness definiteness) {
  switch (definiteness) {
    case NewtonDefiniteness::exact:
      return std::make_unique<FixedHessian>(Definiteness::exact);
    case NewtonDefiniteness::clamped:
      return std::make_unique<FixedHessian>(Definiteness::clamped);
    case NewtonDefiniteness::absolute:
      return std::make_unique<FixedHessian>(Definiteness::absolute);
    case NewtonDefiniteness::on_demand:
      return std::make_unique<HessianOnDemand>();
    case NewtonDefiniteness::progressive:
      return std::make_unique<ProgressiveHessian>();
  }
  return nullptr;
}

}  // namespace aspic
