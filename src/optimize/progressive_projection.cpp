#include "optimize/progressive_projection.h"

#include <algorithm>
#include <cmath>

#include "math/vectors.h"

namespace aspic {
namespace {

constexpr double kTighten = 0.5, kRelax = 2;  // as in [Fernandez-Fernandez et al. 2026]
constexpr double kAll = 1e-6;                 // fraction of the largest residual below which all elements are selected

double residual(std::span<const double> g, size_t vertex) {
  return std::max({std::abs(g[3 * vertex]), std::abs(g[3 * vertex + 1]), std::abs(g[3 * vertex + 2])});
}

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

}  // namespace aspic
