#include "energy/grab_paths.h"

#include <algorithm>
#include <optional>

namespace aspic {
namespace {

constexpr double kSameTime = 1e-9;  // tolerance relative to a path segment; step times have round-off

// Returns the target on the path segment that ends at or after `time`, such that a step to a path point ends exactly
// there. Returns nothing outside the path.
std::optional<Vec3d> target_at(const GrabPath& path, double time) {
  const std::vector<PathPoint>& points = path.path;
  if (time <= points[0].time + kSameTime * (points[1].time - points[0].time)) return std::nullopt;
  const auto is_before = [](const PathPoint& point, double t) { return point.time < t; };
  auto to = std::lower_bound(points.begin() + 1, points.end(), time, is_before);
  const auto reaches = [&](auto end) { return end->time + kSameTime * (end->time - (end - 1)->time) >= time; };
  if (to > points.begin() + 1 && reaches(to - 1)) --to;
  if (to == points.end()) return std::nullopt;
  Grab grab;
  grab.from = (to - 1)->position;
  grab.to = to->position;
  grab.from_time = (to - 1)->time;
  grab.to_time = to->time;
  return grab.target(time);
}

}  // namespace

double GrabPaths::value(Positions x, const Context& context) const {
  double V = 0;
  for (const GrabPath& path : paths_)
    if (const auto target = target_at(path, context.time)) V += path.grab.value(x, *target);
  return V;
}

void GrabPaths::add_gradient(Positions x, const Context& context, double scale, std::span<double> g) const {
  for (const GrabPath& path : paths_)
    if (const auto target = target_at(path, context.time)) path.grab.add_gradient(x, *target, scale, g);
}

void GrabPaths::bind(const BlockPattern& pattern) {
  blocks_.clear();
  for (const GrabPath& path : paths_) blocks_.emplace_back(path.grab, pattern);
}

int GrabPaths::add_hessian(Positions, const Context& context, double scale, const Projection&, BlockSparse& H) const {
  for (size_t k = 0; k < paths_.size(); ++k)
    if (target_at(paths_[k], context.time)) blocks_[k].add_hessian(paths_[k].grab, scale, H);
  return 0;
}

}  // namespace aspic
