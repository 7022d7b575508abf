#include "data/closest_point_fit.h"

#include <algorithm>
#include <cmath>

#include "data/rigid_motion.h"
#include "model/limits.h"

namespace aspic {
namespace {

constexpr double kAlong = 0.05;  // weight of the distance along the surface: keeps the system definite
// Change of the scale; at the bound a guess is dropped. The least ratio of units is 2.54.
constexpr double kLargestScale = 2;
constexpr int kMaxDamping = 12;  // trials that raise the damping tenfold each, from its least value to its largest

// Solves (A + damping I) x = b by elimination; A is symmetric and positive semidefinite.
std::array<double, 7> solved(std::array<double, 49> A, std::array<double, 7> b, double damping) {
  for (int i = 0; i < 7; ++i) A[8 * i] += damping;
  for (int k = 0; k < 7; ++k)
    for (int i = k + 1; i < 7; ++i) {
      const double l = A[7 * i + k] / A[8 * k];
      for (int j = k; j < 7; ++j) A[7 * i + j] -= l * A[7 * k + j];
      b[i] -= l * b[k];
    }
  for (int k = 6; k >= 0; --k) {
    for (int j = k + 1; j < 7; ++j) b[k] -= A[7 * k + j] * b[j];
    b[k] /= A[8 * k];
  }
  return b;
}

std::vector<Vec3d> moved_points(const AffineMap& map, std::span<const Vec3d> points) {
  std::vector<Vec3d> moved;
  for (const Vec3d& p : points) moved.push_back(map(p));
  return moved;
}

}  // namespace

Vec3d ClosestPointFit::motion(int k, const Vec3d& from_center, double length) {
  Vec3d axis{};
  if (k < 6) axis[k % 3] = 1;
  if (k < 3) return axis;
  return (1 / length) * (k < 6 ? cross(axis, from_center) : from_center);
}

// Residuals: the distance of each point along the normal of the surface, and the whole distance with a small weight.
ClosestPointFit::System ClosestPointFit::system(const AffineMap& map, const Vec3d& center, double length) const {
  System s;
  const double share = 1 / static_cast<double>(points_.size());
  for (const Vec3d& p : points_) {
    const Vec3d x = map(p);
    const ProjectedPoint nearest = surface_.nearest(x);
    const Vec3d gap = x - nearest.position;
    s.squares += share * dot(gap, gap);
    s.largest = std::max(s.largest, nearest.distance);
    std::array<Vec3d, 7> J{};
    for (int k = 0; k < (scales_ ? 7 : 6); ++k) J[k] = motion(k, x - center, length);
    for (int i = 0; i < 7; ++i) {
      const double along = dot(nearest.normal, J[i]);
      s.b[i] -= share * (along * dot(nearest.normal, gap) + kAlong * dot(J[i], gap));
      for (int j = 0; j < 7; ++j) {
        const double both = share * along * dot(nearest.normal, J[j]);
        s.normal[7 * i + j] += both;
        s.A[7 * i + j] += both + share * kAlong * dot(J[i], J[j]);
      }
    }
  }
  return s;
}

AffineMap ClosestPointFit::moved(const AffineMap& map, const std::array<double, 7>& step, const Vec3d& center,
                                 double length) const {
  const Vec3d turn = (1 / length) * Vec3d{{step[3], step[4], step[5]}};
  const Mat3d R = norm(turn) > 0 ? rotation(turn, norm(turn)) : identity3<double>();
  const double factor = scales_ ? std::exp(step[6] / length) : 1;
  AffineMap next;
  next.A = factor * (R * map.A);
  next.b = factor * (R * (map.b - center)) + center + Vec3d{{step[0], step[1], step[2]}};
  return next;
}

bool ClosestPointFit::is_scale_at_bound(const AffineMap& guess, const AffineMap& found) const {
  return scales_ && std::abs(std::log(scale_of(found) / scale_of(guess))) > 0.999 * std::log(kLargestScale);
}

PoseFit ClosestPointFit::run(const AffineMap& guess, int iterations) const {
  AffineMap map = guess;
  double damping = 1e-6;
  PoseFit fit;
  for (int i = 0;; ++i) {
    const std::vector<Vec3d> x = moved_points(map, points_);
    const Vec3d center = centroid_of(x);
    const double length = std::max(spread_of(x), 1e-300);
    const System here = system(map, center, length);
    fit = {map, std::sqrt(here.squares), here.largest, here.normal};
    if (i == iterations) return fit;
    double size = 0;
    bool is_better = false;
    for (int trial = 0; trial < kMaxDamping && !is_better; ++trial) {
      std::array<double, 7> step = solved(here.A, here.b, damping);
      if (!scales_) step[6] = 0;
      AffineMap next = moved(map, step, center, length);
      const double change = std::log(scale_of(next) / scale_of(guess)), limit = std::log(kLargestScale);
      if (std::abs(change) > limit) {
        step[6] -= length * (change - std::copysign(limit, change));
        next = moved(map, step, center, length);
      }
      const double squares = system(next, center, length).squares;
      // A smaller scale alone shortens all distances, so they are compared in the scale of the points.
      is_better = squares / std::pow(scale_of(next), 2) <= here.squares / std::pow(scale_of(map), 2);
      damping = is_better ? std::max(damping / 4, 1e-9) : std::min(10 * damping + 1e-6, 1e3);
      if (!is_better) continue;
      map = next;
      for (const double s : step) size = std::max(size, std::abs(s));
    }
    if (!is_better || size < kFinest * length) iterations = i + 1;
  }
}

}  // namespace aspic
