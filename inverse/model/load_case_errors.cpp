// Derivatives of the residuals of a case with respect to systematic errors.
#include <algorithm>

#include "mesh/vertices.h"
#include "model/gauge.h"
#include "model/load_case.h"

namespace aspic {
namespace {

// Adds scale times the velocity of each vertex in a rigid motion about `center`.
void add_rigid_motion(const Twist& twist, const Vec3d& center, std::span<const double> x, double scale,
                      std::span<double> dx) {
  for (int v = 0; v < static_cast<int>(x.size() / 3); ++v) {
    const Vec3d d = twist.center + cross(twist.rotation, point(x, v) - center);
    for (int r = 0; r < 3; ++r) dx[3 * v + r] += scale * d[r];
  }
}

}  // namespace

void LoadedBody::store_wrench() {
  if (experiment_.errors.empty()) return;
  linear_wrench_ = wrench();
  if (grip_) linear_force_ = force_;
}

bool LoadedBody::multiply_by_error(const SystematicError& error, std::span<double> dr) {
  if (!concerns(error, load_)) return true;
  if (error.kind == ErrorKind::layer) return multiply_by_layer(dr);
  if (error.kind == ErrorKind::friction) return multiply_by_friction(dr);
  if (error.kind == ErrorKind::rim) return multiply_by_rim(dr);
  if (error.kind >= ErrorKind::tare) {
    put_change_of_reading(error, dr);
    return true;
  }
  Wrench change;
  const Twist twist = twist_of(error, load_);
  if (!(grip_ ? move_grip(twist, change) : move_probe(twist, change))) return false;
  put_change(change, dr);
  return true;
}

void LoadedBody::put_change_of_reading(const SystematicError& error, std::span<double> dr) const {
  const std::span<const double> x = equilibrium_.linearized_x();
  size_t i = 0;
  const auto put = [&](const Vec3d& d, const Vec3d& sigma) {
    for (int k = 0; k < 3; ++k) dr[i++] = d[k] / sigma[k];
  };
  for (const MarkerReading& reading : load_.positions) {
    Vec3d motion{};
    const SurfacePoint& marker = experiment_.markers[reading.marker];
    if (error.kind == ErrorKind::length_scale)
      for (int k = 0; k < 3; ++k)
        motion =
            motion + marker.weights[k] * (point(x, marker.vertices[k]) - experiment_.mesh.rest[marker.vertices[k]]);
    put(motion, reading.sigma);
  }
  const bool scales = error.kind == ErrorKind::force_scale;
  SystematicError one = error;
  one.value = 1;
  const Vec3d force = scales                          ? linear_wrench_.force + tare_of(experiment_.errors, load_)
                      : error.kind == ErrorKind::tare ? tare_of({one}, load_)
                                                      : Vec3d{};
  if (has_force()) put(to_gauge(load_.gauge, force), gauge_sigma(load_.gauge, load_.force_sigma));
  const Vec3d torque = scales ? linear_wrench_.torque : Vec3d{};
  if (has_torque()) put(to_gauge(load_.torque_gauge, torque), gauge_sigma(load_.torque_gauge, load_.torque_sigma));
}

// The energy of the probe is invariant under common rigid motions v of body and indenter, so its gradient g changes
// with the pose alone by w x g - H v, w the angular velocity, and its wrench by w x wrench - d(wrench)/dx v.
bool LoadedBody::move_probe(const Twist& twist, Wrench& change) {
  const std::span<const double> x = equilibrium_.linearized_x();
  std::fill(xbar_.begin(), xbar_.end(), 0.0);
  probe_->add_wrench_transposed(x, {twist.center, twist.rotation}, -1, xbar_);  // H v - w x g
  if (friction_) friction_->add_pose_product(x, twist.center, twist.rotation, -1, xbar_);
  ++counts_.solves;
  if (!solved(equilibrium_.solve_stiffness(xbar_, dx_))) return false;
  std::copy(dx_.begin(), dx_.end(), xbar_.begin());
  add_rigid_motion(twist, load_.pose.center, x, -1, xbar_);
  change = wrench_product(xbar_);
  change.force = change.force + cross(twist.rotation, linear_wrench_.force);
  change.torque = change.torque + cross(twist.rotation, linear_wrench_.torque);
  return true;
}

bool LoadedBody::move_grip(const Twist& twist, Wrench& change) {
  const std::span<const double> x = equilibrium_.linearized_x();
  const Vec3d center = load_.grip->center + load_.grip->displacement;
  std::fill(xbar_.begin(), xbar_.end(), 0.0);
  add_rigid_motion(twist, center, x, 1, xbar_);
  std::fill(dx_.begin(), dx_.end(), 0.0);
  for (const int v : load_.grip->vertices) std::copy_n(xbar_.begin() + 3 * v, 3, dx_.begin() + 3 * v);
  const std::vector<double> prescribed = dx_;
  equilibrium_.force_tangent({}, prescribed, xbar_);
  for (double& b : xbar_) b = -b;
  ++counts_.solves;
  if (!solved(equilibrium_.solve_stiffness(xbar_, dx_))) return false;
  for (size_t i = 0; i < dx_.size(); ++i) dx_[i] += prescribed[i];
  equilibrium_.force_tangent({}, dx_, force_);
  change = wrench_of(*load_.grip, x, force_);
  for (const int v : load_.grip->vertices)
    change.torque = change.torque + cross(cross(twist.rotation, point(x, v) - center), point(linear_force_, v));
  return true;
}

}  // namespace aspic
