// The commands of the probe: a tip touches the body, is pressed in, and lifted.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "mesh/tet_shape.h"
#include "viewer/session_impl.h"
#include "viewer/touch_place.h"

namespace aspic::viewer {
namespace {

constexpr double kDeepestTip = 10;  // of the body's size

double size_of(const Surface& surface) {
  Vec3d lower = surface.rest.front(), upper = lower;
  for (const Vec3d& X : surface.rest)
    for (int r = 0; r < 3; ++r) lower[r] = std::min(lower[r], X[r]), upper[r] = std::max(upper[r], X[r]);
  return length(upper - lower);
}

double positive(Arguments& arguments, const char* key, double most) {
  const double value = arguments.number(key);
  if (!(value > 0 && value <= most))
    refuse(key, value, fmt::format("a positive number, at most {:g}, is expected", most));
  return value;
}

Json command_of(const SurfacePoint& point, const Tip& tip) {
  return {{"do", "touch"},
          {"side", "a"},
          {"triangle", point.triangle},
          {"weights", {point.weights[0], point.weights[1], point.weights[2]}},
          {"shape", tip.shape == TipShape::disc ? "disc" : "sphere"},
          {"contact", tip.contact == TipContact::sliding ? "sliding" : "bonded"},
          {"radius", tip.radius},
          {"stiffness", tip.stiffness}};
}

}  // namespace

Tip tip_of(Arguments& touch, const Model& model, const Surface& cage) {
  Tip tip{.radius = usual_radius(cage)};
  if (touch.has("shape")) {
    const Json& shape = touch.value("shape");
    if (shape != "sphere" && shape != "disc") refuse("touch.shape", shape, "'sphere' or 'disc' is expected");
    tip.shape = shape == "disc" ? TipShape::disc : TipShape::sphere;
  }
  if (touch.has("contact")) {
    const Json& contact = touch.value("contact");
    if (contact != "bonded" && contact != "sliding")
      refuse("touch.contact", contact, "'bonded' or 'sliding' is expected");
    tip.contact = contact == "sliding" ? TipContact::sliding : TipContact::bonded;
  }
  if (touch.has("radius")) tip.radius = positive(touch, "radius", kDeepestTip * size_of(cage));
  tip.stiffness = touch.has("stiffness") ? positive(touch, "stiffness", 1e20) : usual_layer(model, tip.radius);
  return tip;
}

// The tip touches the boundary of the tets, whatever skin is shown.
void Session::Impl::touch(Arguments& arguments) {
  ShownSide& touched = side_of(arguments);
  const int triangle = arguments.integer("triangle", 0, touched.surface.triangle_count() - 1);
  SurfacePoint point{triangle, arguments.weights("weights")};
  const Surface cage = boundary_of(a->side.model());
  const Tip tip = tip_of(arguments, a->side.model(), cage);
  arguments.finish();
  if (&touched == b.get()) point = same_point(b->surface, point, a->surface);
  touch(point, tip);
}

void Session::Impl::touch(const SurfacePoint& point, const Tip& tip) {
  std::vector<std::shared_ptr<const Touch>> touches;
  for (const ShownSide* shown : {a.get(), b.get()}) {
    if (!shown) continue;
    const Model& model = shown->side.model();
    const Surface cage = boundary_of(model);
    const SurfacePoint here = same_point(a->surface, point, cage);
    touches.push_back(
        std::make_shared<const Touch>(touch_at(model, cage, here, tip, shown->side.simulation().state().q)));
  }
  a->side.touch(touches.front());
  if (b) b->side.touch(touches.back());
  note(command_of(point, tip));
}

void Session::Impl::press(Arguments& arguments) {
  const double depth = arguments.number("depth");
  const Vec3d shift = arguments.has("shift") ? arguments.vector("shift") : Vec3d{};
  arguments.finish();
  if (!a->side.touched()) throw InvalidInput("press: there is no tip; let it touch the body first");
  const double most = kDeepestTip * size_of(a->surface);
  if (!(std::abs(depth) <= most && length(shift) <= most))
    throw InvalidInput(fmt::format("press: further than {:g} m; choose less", most));
  Json done = {{"do", "press"}, {"depth", depth}};
  if (dot(shift, shift) > 0) done["shift"] = {shift[0], shift[1], shift[2]};
  note(std::move(done));
  for (ShownSide* shown : {a.get(), b.get()})
    if (shown && shown->side.touched()) shown->side.press(pressed(*shown->side.touched(), depth, shift));
}

void Session::Impl::lift(Arguments& arguments) {
  arguments.finish();
  if (!a->side.touched()) return;
  note({{"do", "lift"}});
  for (ShownSide* shown : {a.get(), b.get()})
    if (shown) shown->side.lift();
}

}  // namespace aspic::viewer
