#include "energy/grab_paths.h"

#include <algorithm>

namespace aspic {
namespace {

constexpr double kSameTime = 1e-9;  // of a part of the path: times of steps are rounded

// The part of the path that leads to `time`, so that a step which ends at a point of the path ends exactly there. An
// inactive spring has no stiffness.
Grab acting_at(const GrabPath& path, double time) {
  const std::vector<PathPoint>& points = path.path;
  if (time <= points[0].time + kSameTime * (points[1].time - points[0].time)) return {};
  const auto is_before = [](const PathPoint& point, double t) { return point.time < t; };
  auto to = std::lower_bound(points.begin() + 1, points.end(), time, is_before);
  const auto reaches = [&](auto end) { return end->time + kSameTime * (end->time - (end - 1)->time) >= time; };
  if (to > points.begin() + 1 && reaches(to - 1)) --to;
  if (to == points.end()) return {};
  Grab grab = path.grab;
  grab.from = (to - 1)->position;
  grab.to = to->position;
  grab.from_time = (to - 1)->time;
  grab.to_time = to->time;
  return grab;
}

}  // namespace

void GrabPaths::begin_step(const StepContext& step) {
  for (size_t k = 0; k < paths_.size(); ++k) springs_[k].set(acting_at(paths_[k], step.time), step.time);
}

double GrabPaths::value(Positions x) const {
  double V = 0;
  for (const GrabSpring& spring : springs_) V += spring.value(x);
  return V;
}

void GrabPaths::add_gradient(Positions x, double scale, std::span<double> g) const {
  for (const GrabSpring& spring : springs_) spring.add_gradient(x, scale, g);
}

void GrabPaths::bind(const BlockPattern& pattern) {
  for (GrabSpring& spring : springs_) spring.bind(pattern);
}

int GrabPaths::add_hessian(Positions x, double scale, const Projection& projection, BlockSparse& H) const {
  int projected = 0;
  for (const GrabSpring& spring : springs_) projected += spring.add_hessian(x, scale, projection, H);
  return projected;
}

void GrabPaths::add_vertex_systems(Positions x, double scale, std::span<const int> vertices, std::span<Vec3d> g,
                                   std::span<Mat3d> H) const {
  for (const GrabSpring& spring : springs_) spring.add_vertex_systems(x, scale, vertices, g, H);
}

}  // namespace aspic
