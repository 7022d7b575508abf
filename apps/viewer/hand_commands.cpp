// The commands of the hand: the mouse pulls, the brush pins.
#include <fmt/format.h>

#include "base/error.h"
#include "mesh/box_tree.h"
#include "viewer/commands.h"
#include "viewer/scene_json.h"
#include "viewer/stage.h"

namespace aspic::viewer {
namespace {

constexpr double kFarthestTarget = 1000;  // distance of a target, relative to the size of the body

Vec3d target_of(Arguments& arguments, const Side& side) {
  const Vec3d target = arguments.vector("target");
  const Box box = bounding_box(side.model().mesh.rest);
  const Vec3d extent = box.upper - box.lower, away = target - 0.5 * (box.lower + box.upper);
  const double reach = kFarthestTarget * norm(extent);
  if (!(dot(away, away) <= reach * reach))
    throw InvalidInput(fmt::format("target: it is more than {:g} m away from the body; choose a nearer one", reach));
  return target;
}

// The nearest vertices of the other surface at rest.
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

// Grabs all sides at the same point. The record has the point of side a.
void grab(Stage& stage, Arguments& arguments) {
  const ShownSide& grabbed = stage.named(arguments);
  const int triangle = arguments.integer("triangle", 0, grabbed.surface.triangle_count() - 1);
  SurfacePoint point{triangle, arguments.weights("weights")};
  const Vec3d target = target_of(arguments, grabbed.side);
  arguments.finish();
  Json weights = arguments.value("weights");
  const Surface& surface = stage.a().surface;
  if (!grabbed.surface.has_same_shape(surface)) {
    point = same_point(grabbed.surface, point, surface);
    weights = point.weights.a;
  }
  stage.record(
      {{"do", "grab"}, {"side", "a"}, {"triangle", point.triangle}, {"weights", weights}, {"target", json_of(target)}});
  for (ShownSide& shown : stage.sides()) {
    const SurfacePoint here = same_point(surface, point, shown.surface);
    const TetPoint in_tet = tet_point(shown.surface, shown.side.model().mesh, here.triangle, here.weights);
    shown.side.edit([&](Tools& tools, Positions x) { tools.hand.grab(in_tet, target, x); });
  }
}

void move(Stage& stage, Arguments& arguments) {
  const Vec3d target = target_of(arguments, stage.a().side);
  arguments.finish();
  if (!stage.a().side.hand().is_grabbing()) throw InvalidInput("move: nothing is grabbed");
  stage.record({{"do", "move"}, {"target", json_of(target)}});
  for (ShownSide& shown : stage.sides()) shown.side.aim([&](Tools& tools) { tools.hand.move(target); });
}

void release(Stage& stage) {
  if (!stage.a().side.hand().is_grabbing()) return;
  stage.record({{"do", "release"}});
  for (ShownSide& shown : stage.sides())
    if (shown.side.hand().is_grabbing()) shown.side.edit([](Tools& tools, Positions) { tools.hand.release(); });
}

void set_stiffness(Stage& stage, Arguments& arguments) {
  const double value = arguments.number("value");
  arguments.finish();
  if (!(value > 0 && value <= 1e15)) refuse("stiffness.value", value, "a positive number, at most 1e15, is expected");
  stage.record({{"do", "stiffness"}, {"value", value}});
  for (ShownSide& shown : stage.sides()) {
    shown.side.set_stiffness(value);
    stage.send_scene(shown);
  }
}

void pin(Stage& stage, Arguments& arguments) {
  const ShownSide& painted = stage.named(arguments);
  std::vector<int> vertices = arguments.indices("vertices", painted.surface.vertex_count());
  const bool pinned = arguments.boolean("pinned");
  arguments.finish();
  const Surface& surface = stage.a().surface;
  vertices = same_vertices(painted.surface, vertices, surface);
  for (ShownSide& shown : stage.sides()) {
    shown.side.pin(anchors(shown.surface, same_vertices(surface, vertices, shown.surface)), pinned);
    stage.send(pins_message(shown));
  }
  stage.body_changed();
  stage.record({{"do", "pin"}, {"side", "a"}, {"vertices", vertices}, {"pinned", pinned}});
}

}  // namespace

void add_hand_commands(Stage& stage, Commands& commands) {
  commands["grab"] = {[&](Arguments& a) { grab(stage, a); }};
  commands["move"] = {[&](Arguments& a) { move(stage, a); }};
  commands["release"] = {plain([&] { release(stage); })};
  commands["stiffness"] = {[&](Arguments& a) { set_stiffness(stage, a); }};
  commands["pin"] = {[&](Arguments& a) { pin(stage, a); }};
}

}  // namespace aspic::viewer
