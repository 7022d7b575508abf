// The commands of the hand: the mouse that pulls, and the brush that pins.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "mesh/box_tree.h"
#include "viewer/session_impl.h"

namespace aspic::viewer {
namespace {

constexpr double kFarthestTarget = 1000;  // of a target, in sizes of the body

Vec3d target_of(Arguments& arguments, const Side& side) {
  const Vec3d target = arguments.vector("target");
  Box box;
  for (const Vec3d& X : side.model().mesh.rest) box.add(X);
  const Vec3d extent = box.upper - box.lower, away = target - 0.5 * (box.lower + box.upper);
  const double reach = kFarthestTarget * std::sqrt(dot(extent, extent));
  if (!(dot(away, away) <= reach * reach))
    throw InvalidInput(fmt::format("target: further than {:g} m from the body; choose a nearer one", reach));
  return target;
}

// For each vertex the one of the other surface that is nearest at rest.
std::vector<int> same_vertices(const Surface& from, const std::vector<int>& vertices, const Surface& to) {
  if (from.has_same_shape(to)) return vertices;
  std::vector<Box> boxes;
  for (const Vec3d& X : to.rest) boxes.push_back({X, X});
  const BoxTree tree(boxes);
  std::vector<int> nearest;
  for (const int v : vertices) {
    double reach = Box::kInfinity;
    int best = 0;
    tree.for_each_near(from.rest[v], reach, [&](int w) {
      const Vec3d away = to.rest[w] - from.rest[v];
      if (dot(away, away) < reach) reach = dot(away, away), best = w;
    });
    nearest.push_back(best);
  }
  return nearest;
}

std::vector<int> anchors(const Surface& surface, const std::vector<int>& vertices) {
  std::vector<int> list;
  for (const int v : vertices) list.push_back(surface.anchor(v));
  return list;
}

}  // namespace

// Both sides are grabbed at the same point. What is recorded is the point of side a, whichever was touched.
void Session::Impl::grab(Arguments& arguments) {
  ShownSide& touched = side_of(arguments);
  const int triangle = arguments.integer("triangle", 0, touched.surface.triangle_count() - 1);
  SurfacePoint point{triangle, arguments.weights("weights")};
  const Vec3d target = target_of(arguments, touched.side);
  arguments.finish();
  Json weights = arguments.value("weights");
  if (&touched == b.get() && !b->surface.has_same_shape(a->surface)) {
    point = same_point(b->surface, point, a->surface);
    weights = {point.weights[0], point.weights[1], point.weights[2]};
  }
  Json done = {{"do", "grab"},
               {"side", "a"},
               {"triangle", point.triangle},
               {"weights", weights},
               {"target", {target[0], target[1], target[2]}}};
  note(std::move(done));
  for (ShownSide* shown : {a.get(), b.get()}) {
    if (!shown) continue;
    const SurfacePoint here = same_point(a->surface, point, shown->surface);
    shown->side.grab(tet_point(shown->surface, shown->side.model().mesh, here.triangle, here.weights), target);
  }
}

void Session::Impl::move(Arguments& arguments) {
  const Vec3d target = target_of(arguments, a->side);
  arguments.finish();
  if (!a->side.is_grabbed()) throw InvalidInput("move: nothing is grabbed");
  note({{"do", "move"}, {"target", {target[0], target[1], target[2]}}});
  for (ShownSide* shown : {a.get(), b.get()})
    if (shown) shown->side.move(target);
}

void Session::Impl::release(Arguments& arguments) {
  arguments.finish();
  if (!a->side.is_grabbed()) return;
  note({{"do", "release"}});
  for (ShownSide* shown : {a.get(), b.get()})
    if (shown) shown->side.release();
}

void Session::Impl::stiffness(Arguments& arguments) {
  const double value = arguments.number("value");
  arguments.finish();
  if (!(value > 0 && value <= 1e15)) refuse("stiffness.value", value, "a positive number, at most 1e15, is expected");
  note({{"do", "stiffness"}, {"value", value}});
  for (ShownSide* shown : {a.get(), b.get()}) {
    if (!shown) continue;
    shown->side.set_stiffness(value);
    tell(scene_message(*shown, field));
  }
}

void Session::Impl::pin(Arguments& arguments) {
  ShownSide& touched = side_of(arguments);
  std::vector<int> vertices = arguments.indices("vertices", touched.surface.vertex_count());
  const bool pinned = arguments.boolean("pinned");
  arguments.finish();
  if (&touched == b.get()) vertices = same_vertices(b->surface, vertices, a->surface);
  for (ShownSide* shown : {a.get(), b.get()}) {
    if (!shown) continue;
    shown->side.pin(anchors(shown->surface, same_vertices(a->surface, vertices, shown->surface)), pinned);
    tell(pins_message(*shown));
  }
  keep_bench();
  ++version;
  note({{"do", "pin"}, {"side", "a"}, {"vertices", vertices}, {"pinned", pinned}});
}

}  // namespace aspic::viewer
