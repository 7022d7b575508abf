#include "energy/grab_spring.h"

#include <algorithm>

namespace aspic {
namespace {

Vec3d entries(Positions x, int vertex) { return {{x[3 * vertex], x[3 * vertex + 1], x[3 * vertex + 2]}}; }

}  // namespace

Vec3d Grab::target(double time) const {
  if (time >= to_time) return to;
  if (time <= from_time) return from;
  const double s = (time - from_time) / (to_time - from_time);
  return (1 - s) * from + s * to;
}

Vec3d Grab::point(Positions x) const {
  Vec3d sum{};
  for (int i = 0; i < 4; ++i) sum = sum + weights[i] * entries(x, vertices[i]);
  return sum;
}

void GrabSpring::set(const Grab& grab, double time) {
  grab_ = grab;
  target_ = grab_.target(time);
  find_slots();
}

Vec3d GrabSpring::force(Positions x) const {
  if (grab_.stiffness == 0) return {};
  return grab_.stiffness * (target_ - grab_.point(x));
}

double GrabSpring::value(Positions x) const {
  if (grab_.stiffness == 0) return 0;
  const Vec3d u = grab_.point(x) - target_;
  return 0.5 * grab_.stiffness * dot(u, u);
}

void GrabSpring::add_gradient(Positions x, double scale, std::span<double> g) const {
  if (grab_.stiffness == 0) return;
  const Vec3d pull = force(x);
  for (int i = 0; i < 4; ++i)
    for (int r = 0; r < 3; ++r) g[3 * grab_.vertices[i] + r] -= scale * grab_.weights[i] * pull[r];
}

void GrabSpring::bind(const BlockPattern& pattern) {
  pattern_ = &pattern;
  find_slots();
}

void GrabSpring::find_slots() {
  if (!pattern_ || grab_.stiffness == 0) return;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      const auto [low, high] = std::minmax(grab_.vertices[i], grab_.vertices[j]);
      slot_[i][j] = pattern_->slot(high, low);
    }
}

int GrabSpring::add_hessian(Positions, double scale, const Projection&, BlockSparse& H) const {
  if (grab_.stiffness == 0) return 0;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j <= i; ++j) {
      const double entry = scale * grab_.stiffness * grab_.weights[i] * grab_.weights[j];
      for (int r = 0; r < 3; ++r) H.block[slot_[i][j]](r, r) += entry;
    }
  return 0;
}

void GrabSpring::add_vertex_systems(Positions x, double scale, std::span<const int> vertices, std::span<Vec3d> g,
                                    std::span<Mat3d> H) const {
  if (grab_.stiffness == 0) return;
  const Vec3d pull = force(x);
  for (size_t k = 0; k < vertices.size(); ++k)
    for (int i = 0; i < 4; ++i) {
      if (vertices[k] != grab_.vertices[i]) continue;
      const double w = grab_.weights[i];
      g[k] = g[k] - (scale * w) * pull;
      for (int r = 0; r < 3; ++r) H[k](r, r) += scale * grab_.stiffness * w * w;
    }
}

}  // namespace aspic
