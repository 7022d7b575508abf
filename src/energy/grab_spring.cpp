#include "energy/grab_spring.h"

#include <algorithm>

namespace aspic {

Vec3d Grab::point(Positions x) const {
  Vec3d sum{};
  for (int i = 0; i < 4; ++i) sum = sum + weights[i] * aspic::point(x, vertices[i]);
  return sum;
}

double Grab::value(Positions x, const Vec3d& target) const {
  if (stiffness == 0) return 0;
  const Vec3d u = point(x) - target;
  return 0.5 * stiffness * dot(u, u);
}

void Grab::add_gradient(Positions x, const Vec3d& target, double scale, std::span<double> g) const {
  if (stiffness == 0) return;
  const Vec3d pull = stiffness * (target - point(x));
  for (int i = 0; i < 4; ++i)
    for (int r = 0; r < 3; ++r) g[3 * vertices[i] + r] -= scale * weights[i] * pull[r];
}

GrabBlocks::GrabBlocks(const Grab& grab, const BlockPattern& pattern) {
  if (grab.stiffness == 0) return;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      const auto [low, high] = std::minmax(grab.vertices[i], grab.vertices[j]);
      slot_[i][j] = pattern.slot(high, low);
    }
}

void GrabBlocks::add_hessian(const Grab& grab, double scale, BlockSparse& H) const {
  if (grab.stiffness == 0) return;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j <= i; ++j) {
      const double entry = scale * grab.stiffness * grab.weights[i] * grab.weights[j];
      for (int r = 0; r < 3; ++r) H.block[slot_[i][j]](r, r) += entry;
    }
}

Vec3d Grab::target(double time) const {
  if (time >= to_time) return to;
  if (time <= from_time) return from;
  const double s = (time - from_time) / (to_time - from_time);
  return (1 - s) * from + s * to;
}

void GrabSpring::set(const Grab& grab) {
  grab_ = grab;
  if (pattern_) blocks_ = {grab_, *pattern_};
}

void GrabSpring::bind(const BlockPattern& pattern) {
  pattern_ = &pattern;
  blocks_ = {grab_, pattern};
}

double GrabSpring::value(Positions x, const Context& context) const {
  return grab_.value(x, grab_.target(context.time));
}

void GrabSpring::add_gradient(Positions x, const Context& context, double scale, std::span<double> g) const {
  grab_.add_gradient(x, grab_.target(context.time), scale, g);
}

int GrabSpring::add_hessian(Positions, const Context&, double scale, const Projection&, BlockSparse& H) const {
  blocks_.add_hessian(grab_, scale, H);
  return 0;
}

}  // namespace aspic
