#include "scene/motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "scene/expression.h"
#include "scene/piecewise_linear.h"
#include "scene/placement.h"

namespace aspic {
namespace {

double end_of(const Value& motion) {
  const Value* until = motion.find("until");
  return until ? until->number() : INFINITY;
}

Motion linear(const Value& motion) {
  const Vec3d velocity = motion["velocity"].vector();
  const double until = end_of(motion);
  return [=](const Vec3d& start, double time) { return start + std::min(time, until) * velocity; };
}

Motion spin(const Value& motion, const std::vector<Vec3d>& starts) {
  const Vec3d axis = motion["axis"].vector();
  const double rate = std::numbers::pi / 180 * motion["rate_deg"].number(), until = end_of(motion);  // [rad/s]
  Vec3d center{};
  if (const Value* given = motion.find("center")) {
    center = given->vector();
  } else {
    for (const Vec3d& x : starts) center = center + x;
    center = (1.0 / static_cast<double>(starts.size())) * center;
  }
  return [=](const Vec3d& start, double time) {
    if (time == 0) return start;  // exactly
    return center + rotation(axis, rate * std::min(time, until)) * (start - center);
  };
}

Motion keyframed(const Value& keyframes) {
  PiecewiseLinear<Vec3d> offset;
  for (const Value& k : keyframes.array()) {
    offset.times.push_back(k["time"].number());
    offset.values.push_back(k["displacement"].vector());
  }
  return [offset](const Vec3d& start, double time) { return start + offset.at(time); };
}

Motion displaced(const Value& displacement) {
  std::vector<Expression> u;
  for (const Value& v : displacement.array())
    u.emplace_back(v.is_text() ? v.text() : number_text(v.number()), ExpressionVariables::position_and_time);
  return [u, place = displacement.place](const Vec3d& start, double time) {
    try {
      return start + Vec3d{{u[0].at(start, time), u[1].at(start, time), u[2].at(start, time)}};
    } catch (const InvalidInput& e) {  // possibly long after the scene was read
      throw error_at(place, e.what());
    }
  };
}

}  // namespace

Motion make_motion(const Value& motion, const std::vector<Vec3d>& starts) {
  if (motion.is_text()) return nullptr;
  if (const Value* m = motion.find("linear")) return linear(*m);
  if (const Value* m = motion.find("rotate")) return spin(*m, starts);
  if (const Value* m = motion.find("keyframes")) return keyframed(*m);
  return displaced(motion["displacement"]);
}

}  // namespace aspic
