#include "mesh/ccd.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace aspic {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kMaxEvaluations = 1000;
// Bound of the error of a distance, in units of round-off of the largest coordinate, from computing it here and from
// rounding the points of both primitives. The smallest accepted gap is much larger.
constexpr double kRounding = 64 * kEpsilon, kSmallestGap = 1000 * kEpsilon;
constexpr double kLanded = 1.01;  // a pair lands when its gap is below this multiple of the landing gap

struct Sizes {
  int first, count;  // points of the first primitive and of both
};

Sizes sizes(PairKind kind) {
  switch (kind) {
    case PairKind::point_point:
      return {1, 2};
    case PairKind::point_edge:
      return {1, 3};
    case PairKind::point_triangle:
      return {1, 4};
    case PairKind::edge_edge:
      return {2, 4};
  }
  return {};
}

// Returns infinity if a coordinate is not finite.
double largest_coordinate(const std::array<Vec3d, 4>& x, int count) {
  double largest = 0;
  for (int i = 0; i < count; ++i)
    for (const double value : x[i].a) largest = std::max(largest, std::isfinite(value) ? std::abs(value) : kInfinity);
  return largest;
}

// Motion relative to the first point. The gap is the distance minus `margin`, which grows at the rate `margin_rate`.
class Approach {
 public:
  Approach(const MovingPair& pair, double offset) : kind_(pair.kind), sizes_(sizes(pair.kind)) {
    for (int i = 0; i < sizes_.count; ++i) {
      x_[i] = pair.x[i] - pair.x[0];
      u_[i] = pair.dx[i] - pair.dx[0];
    }
    const double extent = largest_coordinate(pair.x, sizes_.count);
    margin_ = offset + kRounding * extent;
    margin_rate_ = kRounding * largest_coordinate(pair.dx, sizes_.count);
    smallest_gap_ = kSmallestGap * extent;
    for_each_couple([&](int i, int j) { speed_ = std::max(speed_, norm(u_[i] - u_[j])); });
    speed_ += margin_rate_;
    advance(0);
  }

  // Moves the pair to alpha.
  void advance(double alpha) {
    for (int i = 0; i < sizes_.count; ++i) at_[i] = x_[i] + alpha * u_[i];
    const Distance distance = pair_distance(kind_, at_);
    ++evaluations_;
    margin_now_ = margin_ + alpha * margin_rate_;
    gap_ = distance.d - margin_now_;
    // Points from the second primitive to the first one, whichever the stencil begins with.
    const bool is_reversed = kind_ == PairKind::edge_edge && distance.point[0] >= 2;
    normal_ = (is_reversed ? -1.0 : 1.0) * distance.normal();
  }

  double gap() const { return gap_; }
  int evaluations() const { return evaluations_; }
  bool is_resolved() const { return gap_ > smallest_gap_ && std::isfinite(gap_) && std::isfinite(speed_); }

  // Increment of alpha that keeps the gap above `least`, from the largest relative speed of the points.
  double additive_step(double least) const { return speed_ > 0 ? (gap_ - least) / speed_ : kInfinity; }

  // Increment of alpha during which all points of the first primitive stay at least `least` ahead of those of the
  // second along the closest direction; 0 if they are not now.
  double directional_step(double least) const {
    double step = kInfinity;
    for_each_couple([&](int i, int j) {
      const double before = dot(normal_, at_[i] - at_[j]) - margin_now_ - least;
      const double rate = margin_rate_ - dot(normal_, u_[i] - u_[j]);
      if (!(before > 0)) {
        step = 0;
      } else if (rate > 0) {
        step = std::min(step, before / rate);
      }
    });
    return step;
  }

 private:
  template <class Visit>
  void for_each_couple(Visit visit) const {
    for (int i = 0; i < sizes_.first; ++i)
      for (int j = sizes_.first; j < sizes_.count; ++j) visit(i, j);
  }

  PairKind kind_;
  Sizes sizes_;
  std::array<Vec3d, 4> x_ = {}, u_ = {}, at_ = {};
  double margin_ = 0, margin_rate_ = 0, margin_now_ = 0, smallest_gap_ = 0, speed_ = 0, gap_ = 0;
  Vec3d normal_ = {};
  int evaluations_ = 0;
};

}  // namespace

SafeStep largest_step(const MovingPair& pair, const StepRule& rule) {
  Approach approach(pair, rule.offset);
  if (!approach.is_resolved()) return {0, StepLimit::resolution, approach.evaluations()};
  const double start = approach.gap(), landing = start > 2 * rule.landing ? rule.landing : start / 5;
  double alpha = 0;
  while (approach.evaluations() < kMaxEvaluations) {
    const double least = approach.gap() > 2 * landing ? landing : landing / 2;  // every step has a minimum length
    const double step = std::max(approach.additive_step(least), approach.directional_step(landing));
    if (!(alpha + step < rule.horizon)) return {rule.horizon, StepLimit::none, approach.evaluations()};
    alpha += step;
    approach.advance(alpha);
    if (!(approach.gap() > kLanded * landing)) return {alpha, StepLimit::gap, approach.evaluations()};
  }
  return {alpha, StepLimit::iterations, approach.evaluations()};
}

}  // namespace aspic
