#include "optimize/convergence.h"

#include <algorithm>
#include <cmath>

namespace aspic {
namespace {

double largest_displacement(std::span<const double> d) {
  double largest = 0;
  for (size_t i = 0; i + 2 < d.size(); i += 3)
    largest = std::max(largest, d[i] * d[i] + d[i + 1] * d[i + 1] + d[i + 2] * d[i + 2]);
  return std::sqrt(largest);
}

bool is_round_off(double gradient_norm, double scale, double round_off, double margin) {
  return std::isfinite(round_off) && gradient_norm <= margin * round_off && gradient_norm <= kResolved * scale;
}

}  // namespace

void Convergence::begin(Objective& E, const MinimizeOptions& options, std::span<const double> g) {
  E_ = &E;
  options_ = &options;
  parts_of_E_ = E.traits().parts;
  if (!parts_of_E_) parts_of_E_ = &whole_.emplace(E);
  is_modified_ = false;
  const size_t count = parts_of_E_->part_count();
  parts_.resize(count);
  for (auto* v : {&first_norms_, &thresholds_, &round_offs_}) v->resize(count);
  measure(g);
  for (size_t k = 0; k < count; ++k) first_norms_[k] = parts_[k].norm;
  note_hessian();
}

void Convergence::measure(std::span<const double> g) { parts_of_E_->measure_parts(g, parts_); }

void Convergence::note_hessian() {
  for (size_t k = 0; k < parts_.size(); ++k) round_offs_[k] = parts_of_E_->part_round_off(static_cast<int>(k));
}

double Convergence::threshold(size_t part) const {
  switch (options_->criterion) {
    case Criterion::scale:
      return options_->tolerance * parts_[part].scale;
    case Criterion::first_gradient:
      return options_->tolerance * first_norms_[part];
    case Criterion::absolute:
      return options_->tolerance * E_->scales().gradient_unit;
    default:
      return options_->tolerance;
  }
}

void Convergence::describe(MinimizeReport& report) {
  double farthest = -1;
  for (size_t k = 0; k < parts_.size(); ++k) {
    const double norm = parts_[k].norm;
    thresholds_[k] = threshold(k);
    const double ratio = norm > 0 ? norm / thresholds_[k] : 0;
    if (ratio <= farthest) continue;
    farthest = ratio;
    report.threshold = thresholds_[k];
    if (!tests_direction()) report.reached = norm;
  }
}

double Convergence::size_of_direction(std::span<const double> g, std::span<const double> d) {
  switch (options_->criterion) {
    case Criterion::velocity:
      return E_->largest(largest_displacement(d)) / options_->h;
    case Criterion::acceleration:
      return E_->largest(largest_displacement(d)) / (options_->h * options_->h);
    default:
      return parts_of_E_->relative_decrement(g, d);
  }
}

// A short direction near a saddle or from a modified Hessian does not imply convergence: the gradient must then be
// small relative to the forces that it sums.
bool Convergence::is_near_minimum(double size, const DirectionReport& made) {
  constexpr double kBalanced = 1e-6;
  if (!made.kept) is_modified_ = made.projected_elements > 0;
  if (made.projected || made.truncated || made.stopped || !(size <= options_->tolerance)) return false;
  return !is_modified_ || std::all_of(parts_.begin(), parts_.end(),
                                      [](const GradientPart& part) { return part.norm <= kBalanced * part.scale; });
}

// Exactly known forces are a hundredth of all forces in soft bodies under their weight. A coarse tolerance may exceed
// them, so only round-off counts then.
double Convergence::lost_accuracy(std::span<const double> x) {
  constexpr double kAllowed = 100, kCoarse = 1e-4;
  const double lost = parts_of_E_->lost_accuracy(x, parts_);
  if (lost <= kAllowed * options_->tolerance) return 0;
  for (size_t k = 0; k < parts_.size() && options_->tolerance >= kCoarse; ++k)
    if (parts_[k].norm > kRoundOffMargin * round_offs_[k]) return 0;
  return lost;
}

bool Convergence::is_at_round_off(double margin) const {
  for (size_t k = 0; k < parts_.size(); ++k) {
    const auto& [norm, scale] = parts_[k];
    const bool has_converged = !tests_direction() && norm <= thresholds_[k];
    if (!has_converged && !is_round_off(norm, scale, round_offs_[k], margin)) return false;
  }
  return true;
}

InnerAccuracy Convergence::inner_accuracy(const MinimizeReport& report) const {
  constexpr double kFinestSolve = 1e-12;  // minimum relative residual that is worth its iterations
  const double norm = report.gradient_norm;
  InnerAccuracy accuracy = {.loosest = options_->max_forcing,
                            .enough = tests_direction() ? 0 : 0.5 * report.threshold / norm};
  if (parts_.size() == 1) return accuracy;
  double smallest = norm;
  for (size_t k = 0; k < parts_.size(); ++k) {
    const bool has_converged = !tests_direction() && parts_[k].norm <= thresholds_[k];
    if (has_converged || parts_[k].norm <= round_offs_[k]) continue;
    smallest = std::min(smallest, parts_[k].norm);
    if (!tests_direction()) accuracy.enough = std::min(accuracy.enough, 0.5 * thresholds_[k] / norm);
  }
  accuracy.loosest = std::max(kFinestSolve, options_->max_forcing * smallest / norm);
  return accuracy;
}

}  // namespace aspic
