#include "dynamics/rigid_motions.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "dynamics/explanation_places.h"
#include "linalg/dense_eigen.h"

namespace aspic {
namespace {

// Fraction of the largest eigenvalue below which pins do not resist a motion.
constexpr double kFree = 1e-10;
// Fraction of the largest load below which changes of forces do not resist a motion.
constexpr double kUnchanged = 1e-6;
constexpr Vec3d kAxes[] = {{{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}};

// u(x) = t + w x (x - c) / L
struct Twist {
  Vec3d t{}, w{};
};

class Body {
 public:
  Body(const Model& model, std::span<const double> x, const BodyRange& range) : model_(model), x_(x), range_(range) {
    Vec3d low = at(first()), high = low;
    for (int v = first(); v < end(); ++v)
      for (int r = 0; r < 3; ++r) low[r] = std::min(low[r], at(v)[r]), high[r] = std::max(high[r], at(v)[r]);
    center_ = 0.5 * (low + high);
    size_ = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2], 1e-300}) / 2;
  }

  std::optional<Twist> free_motion() const {
    for (const int count : {3, 6})
      for (const Twist& motion : free_of_pins(count))
        if (!is_resisted_by_loads(motion)) return motion;
    return std::nullopt;
  }

  RigidMotion described(const Twist& m, int body) const {
    const double turn = norm(m.w);
    if (turn < 1e-6) return {body, upright(m.t)};
    return {body, upright(m.w), true, rounded(center_ + (size_ / (turn * turn)) * cross(m.w, m.t), 1e-9 * size_)};
  }

 private:
  int first() const { return range_.first_vertex; }
  int end() const { return first() + range_.vertex_count; }
  Vec3d at(int v) const {
    const size_t i = 3 * static_cast<size_t>(v);
    return {{x_[i], x_[i + 1], x_[i + 2]}};
  }
  Vec3d arm(int v) const { return (1 / size_) * (at(v) - center_); }

  // Normalizes to length 1 with a positive largest component.
  static Vec3d upright(Vec3d d) {
    double most = 0;
    for (int r = 0; r < 3; ++r)
      if (std::abs(d[r]) > std::abs(most) * (1 + 1e-6)) most = d[r];
    return rounded(((most < 0 ? -1 : 1) / norm(d)) * d, 1e-6);
  }

  // Replaces components within round-off of zero by +0.
  static Vec3d rounded(Vec3d v, double round_off) {
    for (int r = 0; r < 3; ++r)
      if (std::abs(v[r]) <= round_off) v[r] = 0;
    return v;
  }

  // Returns the motions that do not move the pins, among the first 3 parameters (translations) or all 6.
  std::vector<Twist> free_of_pins(int count) const {
    std::vector<double> A(static_cast<size_t>(count) * count);
    double trace = 0;
    for (const Pin& pin : model_.pins)
      for (const int v : pin.vertices) {
        if (v < first() || v >= end()) continue;
        for (const Vec3d& n : pin.directions.empty() ? std::span<const Vec3d>(kAxes) : pin.directions) {
          const Vec3d m = cross(arm(v), n);
          const std::array<double, 6> row = {n[0], n[1], n[2], m[0], m[1], m[2]};
          for (int i = 0; i < count; ++i)
            for (int j = 0; j < count; ++j) A[i + count * j] += row[i] * row[j];
          trace += dot(n, n);
        }
      }
    const DenseEigen eigen = dense_eigen(count, A);
    std::vector<Twist> motions;
    for (int k = 0; k < count; ++k) {
      if (eigen.values[k] > kFree * trace) continue;
      const double* q = &eigen.vectors[static_cast<size_t>(count) * k];
      Twist m{{{q[0], q[1], q[2]}}, {}};
      if (count == 6) m.w = {{q[3], q[4], q[5]}};
      motions.push_back(m);
    }
    return motions;
  }

  // Returns whether loads, such as springs to points, change if the body moves by a small fraction of its size.
  bool is_resisted_by_loads(const Twist& m) const {
    constexpr double kPart = 1e-2;
    std::vector<double> moved(x_.begin(), x_.end()), here(x_.size()), there(x_.size());
    for (int v = first(); v < end(); ++v)
      for (int r = 0; r < 3; ++r)
        moved[3 * static_cast<size_t>(v) + r] += kPart * size_ * (m.t + cross(m.w, arm(v)))[r];
    for (const auto& V : model_.loads) {
      const ActiveTerm load(*V);
      load.add_gradient(x_, 1, here);
      load.add_gradient(moved, 1, there);
    }
    double largest = 0, change = 0;
    for (size_t i = 0; i < here.size(); ++i) {
      largest = std::max({largest, std::abs(here[i]), std::abs(there[i])});
      change = std::max(change, std::abs(there[i] - here[i]));
    }
    return change > kUnchanged * largest;
  }

  const Model& model_;
  std::span<const double> x_;
  const BodyRange& range_;
  Vec3d center_{};
  double size_ = 1;
};

std::string vector_text(const Vec3d& v) {
  return "(" + places::text(v[0]) + ", " + places::text(v[1]) + ", " + places::text(v[2]) + ")";
}

}  // namespace

std::optional<RigidMotion> free_rigid_motion(const Model& model, std::span<const double> x) {
  const BodyRange whole{"", 0, model.mesh.vertex_count(), 0, model.mesh.tet_count()};
  const std::span<const BodyRange> bodies =
      model.bodies.empty() ? std::span<const BodyRange>(&whole, 1) : std::span<const BodyRange>(model.bodies);
  for (size_t b = 0; b < bodies.size(); ++b) {
    if (bodies[b].vertex_count == 0) continue;
    const Body body(model, x, bodies[b]);
    if (const std::optional<Twist> motion = body.free_motion()) return body.described(*motion, static_cast<int>(b));
  }
  return std::nullopt;
}

std::string to_string(const RigidMotion& motion) {
  if (!motion.is_rotation) return "slide along " + vector_text(motion.along);
  return "rotate about the axis through " + vector_text(motion.point) + " m along " + vector_text(motion.along);
}

}  // namespace aspic
