#include "model/systematic_errors.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace aspic {
namespace {

struct Quaternion {
  double w;
  Vec3d v;
};

Quaternion quaternion(const Vec3d& rotation) {
  const double angle = norm(rotation);
  const double factor = angle > 1e-8 ? std::sin(angle / 2) / angle : 0.5 - angle * angle / 48;
  return {std::cos(angle / 2), factor * rotation};
}

Quaternion operator*(const Quaternion& a, const Quaternion& b) {
  return {a.w * b.w - dot(a.v, b.v), a.w * b.v + b.w * a.v + cross(a.v, b.v)};
}

// Rotation vector of the rotation `first`, followed by `then`. Angles are at most pi.
Vec3d rotation_after(const Vec3d& then, const Vec3d& first) {
  Quaternion q = quaternion(then) * quaternion(first);
  if (q.w < 0) q = {-q.w, -1.0 * q.v};
  const double sine = norm(q.v);
  return (sine > 1e-8 ? 2 * std::atan2(sine, q.w) / sine : 2.0) * q.v;
}

Vec3d rotated(const Vec3d& rotation, const Vec3d& u) {
  const Quaternion q = quaternion(rotation);
  return u + 2.0 * cross(q.v, cross(q.v, u) + q.w * u);
}

Vec3d unit_vector(int axis) {
  Vec3d e{};
  e[axis] = 1;
  return e;
}

// Direction of the motion of an indenter since the touch, or of a grip since rest; 0 without motion.
Vec3d direction_of_motion(const LoadCase& load) {
  const Vec3d way = load.grip ? load.grip->displacement : load.pose.center - load.touch.center;
  const double length = norm(way);
  return length > 0 ? (1 / length) * way : Vec3d{};
}

bool is_of_pose(ErrorKind kind) {
  return kind == ErrorKind::position || kind == ErrorKind::rotation || kind == ErrorKind::backlash;
}

bool is_of_tip(ErrorKind kind) {
  return kind == ErrorKind::layer || kind == ErrorKind::friction || kind == ErrorKind::rim;
}

const std::string& scope_of(ErrorKind kind, const LoadCase& load) {
  if (kind == ErrorKind::position || kind == ErrorKind::rotation) return load.group;
  return is_of_tip(kind) ? load.tip : load.session;
}

double sigma_of_tip(ErrorKind kind, const LoadCase& load) {
  if (kind == ErrorKind::layer) return load.layer_sigma.value_or(0);
  return kind == ErrorKind::friction ? load.friction_sigma : load.rim_sigma;
}

bool can_change(ErrorKind kind, const LoadCase& load) {
  if (is_of_pose(kind) && !load.indenter && !load.grip) return false;
  if (is_of_pose(kind)) return kind != ErrorKind::backlash || norm(direction_of_motion(load)) > 0;
  if (is_of_tip(kind)) return load.indenter && sigma_of_tip(kind, load) > 0;
  if (kind == ErrorKind::length_scale) return !load.positions.empty();
  return load.force || (load.torque && kind == ErrorKind::force_scale);
}

// Axes of the errors of a case: their number, from the first one on.
std::pair<int, int> axes_of(ErrorKind kind, const LoadCase& load) {
  if (kind == ErrorKind::tare) return load.gauge ? std::pair{SystematicError::kAlongGauge, 1} : std::pair{0, 3};
  return {0, kind == ErrorKind::position || kind == ErrorKind::rotation ? 3 : 1};
}

double sigma_of(ErrorKind kind, const LoadCase& load, const ErrorSigmas& sigmas) {
  return is_of_tip(kind) ? sigma_of_tip(kind, load) : sigmas[static_cast<size_t>(kind)];
}

// Sum of the values of the errors of one kind that concern a case.
double total(const std::vector<SystematicError>& errors, ErrorKind kind, const LoadCase& load) {
  double sum = 0;
  for (const SystematicError& e : errors)
    if (e.kind == kind && concerns(e, load)) sum += e.value;
  return sum;
}

Vec3d total_rotation(const std::vector<SystematicError>& errors, const LoadCase& load) {
  Vec3d sum{};
  for (const SystematicError& e : errors)
    if (e.kind == ErrorKind::rotation && concerns(e, load)) sum[e.axis] += e.value;
  return sum;
}

void correct_load(const std::vector<SystematicError>& errors, LoadCase& load) {
  const Vec3d back = direction_of_motion(load), turn = total_rotation(errors, load);
  Vec3d shift = -total(errors, ErrorKind::backlash, load) * back;
  for (const SystematicError& e : errors)
    if (e.kind == ErrorKind::position && concerns(e, load)) shift[e.axis] += e.value;
  load.turned = turn;
  load.backward = -1.0 * back;
  if (load.grip) {
    load.grip->displacement = load.grip->displacement + shift;
    load.grip->rotation = rotation_after(turn, load.grip->rotation);
  }
  if (!load.indenter) return;
  load.pose.center = load.pose.center + shift;
  load.pose.axis = rotated(turn, load.pose.axis);
  load.pose.rotation = rotation_after(turn, load.pose.rotation);
  load.indenter->stiffness *= std::exp(total(errors, ErrorKind::layer, load));
  load.indenter->friction *= std::exp(total(errors, ErrorKind::friction, load));
  load.indenter->rim *= std::exp(total(errors, ErrorKind::rim, load));
}

void correct_readings(const Experiment& experiment, LoadCase& load) {
  const double force = std::exp(-total(experiment.errors, ErrorKind::force_scale, load)),
               length = std::exp(-total(experiment.errors, ErrorKind::length_scale, load));
  for (MarkerReading& r : load.positions) {
    const Vec3d X = at_rest(experiment, experiment.markers[r.marker]);
    r.position = X + length * (r.position - X);
    r.sigma = length * r.sigma;
  }
  if (load.force) load.force = force * *load.force - tare_of(experiment.errors, load);
  if (load.torque) load.torque = force * *load.torque;
  load.force_sigma = force * load.force_sigma;
  load.torque_sigma = force * load.torque_sigma;
}

// V = sum of (-1)^k [w]^k / (k + 1)! maps a change of the rotation vector to the angular velocity: the left Jacobian of
// the exponential map.
Vec3d angular_velocity(const Vec3d& rotation, const Vec3d& change) {
  const double angle = norm(rotation), squared = angle * angle;
  const bool is_small = angle < 1e-4;
  const double a = is_small ? 0.5 - squared / 24 : (1 - std::cos(angle)) / squared;
  const double b = is_small ? 1.0 / 6 - squared / 120 : (angle - std::sin(angle)) / (squared * angle);
  const Vec3d once = cross(rotation, change);
  return change + a * once + b * cross(rotation, once);
}

}  // namespace

bool concerns(const SystematicError& error, const LoadCase& load) {
  if (!can_change(error.kind, load) || scope_of(error.kind, load) != error.scope) return false;
  const auto [first, count] = axes_of(error.kind, load);
  return error.axis >= first && error.axis < first + count;
}

bool is_of_group(const SystematicError& error) {
  return error.kind == ErrorKind::position || error.kind == ErrorKind::rotation;
}

std::vector<SystematicError> systematic_errors(const std::vector<LoadCase>& cases, const ErrorSigmas& sigmas) {
  std::vector<SystematicError> errors;
  for (int k = 0; k < kErrorKinds; ++k)
    for (const LoadCase& load : cases) {
      const auto kind = static_cast<ErrorKind>(k);
      const double sigma = sigma_of(kind, load, sigmas);
      if (!(sigma > 0) || !can_change(kind, load)) continue;
      const auto [first, count] = axes_of(kind, load);
      for (int axis = first; axis < first + count; ++axis) {
        const SystematicError error{kind, axis, scope_of(kind, load), sigma, 0};
        const bool is_listed = std::any_of(errors.begin(), errors.end(), [&](const SystematicError& e) {
          return e.kind == kind && e.axis == axis && e.scope == error.scope;
        });
        if (!is_listed) errors.push_back(error);
      }
    }
  return errors;
}

std::string name_of(const SystematicError& error) {
  constexpr const char* kNames[] = {"position",     "rotation", "backlash", "layer stiffness", "tare", "force scale",
                                    "length scale", "friction", "rim"};
  constexpr const char* kAxes[] = {" x", " y", " z", " along the axis"};
  std::string name = kNames[static_cast<size_t>(error.kind)];
  if (is_of_group(error) || error.kind == ErrorKind::tare) name += kAxes[error.axis];
  return error.scope.empty() ? name : name + " of '" + error.scope + "'";
}

std::string unit_of(const SystematicError& error) {
  if (error.kind == ErrorKind::position || error.kind == ErrorKind::backlash) return "m";
  if (error.kind == ErrorKind::rotation) return "rad";
  return error.kind == ErrorKind::tare ? "N" : "";
}

Vec3d tare_of(const std::vector<SystematicError>& errors, const LoadCase& load) {
  Vec3d sum{};
  for (const SystematicError& e : errors)
    if (e.kind == ErrorKind::tare && concerns(e, load))
      sum = sum + e.value * (e.axis == SystematicError::kAlongGauge ? *load.gauge : unit_vector(e.axis));
  return sum;
}

Corrected without_errors(OnMesh measured, std::span<const double> values) {
  ASPIC_CHECK(values.size() == measured.errors.size());
  for (size_t k = 0; k < values.size(); ++k) measured.errors[k].value = values[k];
  for (LoadCase& load : measured.cases) {
    correct_load(measured.errors, load);
    correct_readings(measured, load);
  }
  return {std::move(measured)};
}

CasePrediction as_read(const Corrected& experiment, const LoadCase& load, CasePrediction prediction) {
  const double force = std::exp(total(experiment.errors, ErrorKind::force_scale, load)),
               length = std::exp(total(experiment.errors, ErrorKind::length_scale, load));
  for (size_t i = 0; i < prediction.markers.size(); ++i) {
    const Vec3d X = at_rest(experiment, experiment.markers[load.positions[i].marker]);
    prediction.markers[i] = X + length * (prediction.markers[i] - X);
  }
  prediction.wrench.force = force * (prediction.wrench.force + tare_of(experiment.errors, load));
  prediction.wrench.torque = force * prediction.wrench.torque;
  return prediction;
}

Twist twist_of(const SystematicError& error, const LoadCase& load) {
  if (!is_of_pose(error.kind) || !concerns(error, load)) return {};
  if (error.kind == ErrorKind::backlash) return {.center = load.backward};
  if (error.kind == ErrorKind::position) return {.center = unit_vector(error.axis)};
  return {.rotation = angular_velocity(load.turned, unit_vector(error.axis))};
}

}  // namespace aspic
