#include "model/grip.h"

namespace aspic {
namespace {

Vec3d at(std::span<const double> x, int v) { return {{x[3 * v], x[3 * v + 1], x[3 * v + 2]}}; }

}  // namespace

GripMotion::GripMotion(const Grip& grip, double part)
    : from_(grip.center),
      to_(grip.center + part * grip.displacement),
      turn_(PlacedIndenter({.rotation = part * grip.rotation}).turn) {}

Vec3d GripMotion::operator()(const Vec3d& X) const { return to_ + turn_ * (X - from_); }

Wrench wrench_of(const Grip& grip, std::span<const double> x, std::span<const double> force) {
  Wrench sum;
  const Vec3d center = grip.center + grip.displacement;
  for (const int v : grip.vertices) {
    sum.force = sum.force + at(force, v);
    sum.torque = sum.torque + cross(at(x, v) - center, at(force, v));
  }
  return sum;
}

// w . (u x f) = f . (w x u)
void add_wrench_of_transposed(const Grip& grip, std::span<const double> x, const Wrench& wbar,
                              std::span<double> force) {
  const Vec3d center = grip.center + grip.displacement;
  for (const int v : grip.vertices) {
    const Vec3d bar = wbar.force + cross(wbar.torque, at(x, v) - center);
    for (int i = 0; i < 3; ++i) force[3 * v + i] += bar[i];
  }
}

}  // namespace aspic
