// The commands of the indenter: touch, press and lift.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "viewer/commands.h"
#include "viewer/scene_json.h"
#include "viewer/stage.h"
#include "viewer/touch_place.h"

namespace aspic::viewer {
namespace {

constexpr double kDeepestIndenter = 10;  // relative to the size of the body

double positive(Arguments& arguments, const char* key, double most) {
  const double value = arguments.number(key);
  if (!(value > 0 && value <= most))
    refuse(key, value, fmt::format("a positive number, at most {:g}, is expected", most));
  return value;
}

Json command_of(const SurfacePoint& point, const Indenter& indenter) {
  Json command = indenter_json(indenter);
  command.update({{"do", "touch"}, {"side", "a"}, {"triangle", point.triangle}, {"weights", json_of(point.weights)}});
  return command;
}

// The indenter touches the boundary of the tets, even if a skin is shown.
void touch(Stage& stage, Arguments& arguments) {
  const ShownSide& touched = stage.named(arguments);
  const int triangle = arguments.integer("triangle", 0, touched.surface.triangle_count() - 1);
  const SurfacePoint shown_point{triangle, arguments.weights("weights")};
  const Model& model = stage.a().side.model();
  const Indenter indenter = indenter_of(arguments, model, boundary_of(model));
  arguments.finish();
  const Surface& surface = stage.a().surface;
  const SurfacePoint point = &touched == stage.b() ? same_point(touched.surface, shown_point, surface) : shown_point;
  std::vector<std::shared_ptr<const FirstContact>> touches;
  for (const ShownSide& shown : stage.sides()) {
    const Surface cage = boundary_of(shown.side.model());
    const SurfacePoint here = same_point(surface, point, cage);
    touches.push_back(std::make_shared<const FirstContact>(
        touch_at(shown.side.model(), cage, here, indenter, shown.side.simulation().state().q)));
  }
  for (size_t s = 0; s < touches.size(); ++s)
    stage.sides()[s].side.edit([&](Tools& tools, Positions) { tools.indenter.touch(touches[s]); });
  stage.record(command_of(point, indenter));
}

void press(Stage& stage, Arguments& arguments) {
  const double depth = arguments.number("depth");
  const Vec3d shift = arguments.has("shift") ? arguments.vector("shift") : Vec3d{};
  arguments.finish();
  if (!stage.a().side.tools().indenter.touch())
    throw InvalidInput("press: there is no indenter; place it on the body first");
  const double most = kDeepestIndenter * size_of(stage.a().surface);
  if (!(std::abs(depth) <= most && norm(shift) <= most))
    throw InvalidInput(fmt::format("press: depth and shift are limited to {:g} m", most));
  Json done = {{"do", "press"}, {"depth", depth}};
  if (dot(shift, shift) > 0) done["shift"] = json_of(shift);
  stage.record(std::move(done));
  for (ShownSide& shown : stage.sides())
    if (const FirstContact* touch = shown.side.tools().indenter.touch())
      shown.side.aim([&](Tools& tools) { tools.indenter.move(pressed(*touch, depth, shift)); });
}

void lift(Stage& stage) {
  if (!stage.a().side.tools().indenter.touch()) return;
  stage.record({{"do", "lift"}});
  for (ShownSide& shown : stage.sides())
    if (shown.side.tools().indenter.touch()) shown.side.edit([](Tools& tools, Positions) { tools.indenter.lift(); });
}

}  // namespace

Indenter indenter_of(Arguments& touch, const Model& model, const Surface& cage) {
  Indenter indenter{.radius = default_radius(cage)};
  if (touch.has("shape") && touch.choice("shape", {"sphere", "disc"}) == "disc") indenter.shape = IndenterShape::disc;
  if (touch.has("contact") && touch.choice("contact", {"bonded", "sliding"}) == "sliding")
    indenter.contact = IndenterContact::sliding;
  if (touch.has("radius")) indenter.radius = positive(touch, "radius", kDeepestIndenter * size_of(cage));
  indenter.stiffness =
      touch.has("stiffness") ? positive(touch, "stiffness", 1e20) : default_layer(model, indenter.radius);
  return indenter;
}

void add_indenter_commands(Stage& stage, Commands& commands) {
  commands["touch"] = {[&](Arguments& a) { touch(stage, a); }};
  commands["press"] = {[&](Arguments& a) { press(stage, a); }};
  commands["lift"] = {plain([&] { lift(stage); })};
}

}  // namespace aspic::viewer
