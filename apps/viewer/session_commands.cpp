#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "mesh/box_tree.h"
#include "viewer/session_impl.h"

namespace aspic::viewer {
namespace {

constexpr double kFarthest = 1000;        // of a target, in sizes of the body
constexpr int kMostCatchingUp = 100'000;  // steps of side b for one of side a

Vec3d target_of(Arguments& arguments, const Side& side) {
  const Vec3d target = arguments.vector("target");
  Box box;
  for (const Vec3d& X : side.model().mesh.rest) box.add(X);
  const Vec3d extent = box.upper - box.lower, away = target - 0.5 * (box.lower + box.upper);
  const double reach = kFarthest * std::sqrt(dot(extent, extent));
  if (!(dot(away, away) <= reach * reach))
    throw InvalidInput(fmt::format("target: further than {:g} m from the body; choose a nearer one", reach));
  return target;
}

// Weights of a triangle's corners, as a page computes them: exact but for rounding to single precision.
Vec3d weights_of(Arguments& arguments) {
  Vec3d weights = arguments.vector("weights");
  double sum = 0;
  for (int c = 0; c < 3; ++c) {
    if (!(weights[c] >= -0.01 && weights[c] <= 1.01))
      refuse("grab.weights", arguments.value("weights"), "three numbers from 0 to 1 are expected");
    weights[c] = std::clamp(weights[c], 0.0, 1.0);
    sum += weights[c];
  }
  if (std::abs(sum - 1) > 0.01) refuse("grab.weights", arguments.value("weights"), "their sum must be 1");
  return (1 / sum) * weights;
}

Vec3d rest_point(const Surface& surface, const SurfacePoint& point) {
  Vec3d rest{};
  for (int c = 0; c < 3; ++c) rest = rest + point.weights[c] * surface.rest[surface.triangles[point.triangle][c]];
  return rest;
}

SurfacePoint same_point(const Surface& from, const SurfacePoint& point, const Surface& to) {
  return from.has_same_shape(to) ? point : nearest_surface_point(to, rest_point(from, point));
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

struct Session::Impl::Command {
  void (Impl::*carry_out)(Arguments&);
  bool takes_over = true;  // changes the physics, which ends a replay
};

const std::map<std::string, Session::Impl::Command>& Session::Impl::commands() {
  static const std::map<std::string, Command> table = {{"play", {&Impl::play, false}},
                                                       {"pause", {&Impl::pause, false}},
                                                       {"step", {&Impl::step, false}},
                                                       {"iterate", {&Impl::iterate, false}},
                                                       {"reset", {&Impl::reset}},
                                                       {"rewind", {&Impl::rewind}},
                                                       {"speed", {&Impl::set_speed, false}},
                                                       {"set", {&Impl::set}},
                                                       {"load", {&Impl::load}},
                                                       {"lesson", {&Impl::lesson}},
                                                       {"grab", {&Impl::grab}},
                                                       {"move", {&Impl::move}},
                                                       {"release", {&Impl::release}},
                                                       {"stiffness", {&Impl::stiffness}},
                                                       {"pin", {&Impl::pin}},
                                                       {"compare", {&Impl::compare}},
                                                       {"end_compare", {&Impl::end_compare}},
                                                       {"colour", {&Impl::colour, false}},
                                                       {"surface", {&Impl::surface}},
                                                       {"replay", {&Impl::replay}},
                                                       {"take", {&Impl::take, false}}};
  return table;
}

void Session::Impl::command(const Json& message, Role role) {
  Arguments arguments(message, "message");
  if (arguments.has("id")) arguments.value("id");
  const std::string what = arguments.text("do", 100);
  const auto& table = commands();
  const auto found = table.find(what);
  if (found == table.end()) {
    std::vector<std::string> known;
    for (const auto& [name, unused] : table) known.push_back(name);
    throw InvalidInput(fmt::format("unknown command '{}'{}", what, suggestion(what, known)));
  }
  if (role != Role::steers && what != "take")
    throw InvalidInput("this page only watches; take over the steering first");
  const bool takes_over = replaying && found->second.takes_over;
  Arguments named(message, what);
  if (named.has("id")) named.value("id");
  named.value("do");
  (this->*found->second.carry_out)(named);
  if (takes_over && what != "replay" && what != "lesson") replaying.reset();
  if (what != "take") tell_state();
}

// ---------------------------------------------------------------- time

void Session::Impl::play(Arguments& arguments) {
  arguments.finish();
  playing = true;
}

void Session::Impl::pause(Arguments& arguments) {
  arguments.finish();
  playing = false;
}

void Session::Impl::step(Arguments& arguments) {
  arguments.finish();
  playing = false;
  const ShownSide* first = &next();
  const int before = first->side.steps_taken();
  take_turn();
  for (int k = 0; b && &next() == b.get() && !stop && k < kMostCatchingUp; ++k) {
    if (first->side.steps_taken() == before) break;  // interrupted
    take_turn();
  }
}

void Session::Impl::iterate(Arguments& arguments) {
  arguments.finish();
  playing = false;
  if (replaying && a->side.iteration() < 0) repeat_due_events();
  ShownSide& shown = next();
  Progress progress = Progress::interrupted;
  try {
    progress = shown.side.iterate(go_on());
  } catch (...) {
    shown.side.rewind(shown.side.steps_taken());
    throw;
  }
  note_progress(progress);
}

void Session::Impl::reset(Arguments& arguments) {
  arguments.finish();
  rewind_to(0);
}

void Session::Impl::rewind(Arguments& arguments) {
  const int step = arguments.integer("step", 0, a->side.steps_taken());
  arguments.finish();
  rewind_to(step);
}

void Session::Impl::rewind_to(int step) {
  playing = false;
  int to = a->side.timeline().nearest(step).step;
  if (b) {
    // Where both sides were at the same time, if that is remembered.
    const double h = std::min(a->side.simulation().options().h, b->side.simulation().options().h);
    const Moment* other = nullptr;
    while (!(other = b->side.timeline().at_time(a->side.timeline().nearest(to).state.time, 1e-6 * h)) && to > 0)
      to = a->side.timeline().nearest(to - 1).step;
    b->side.rewind(other ? other->step : 0);
  }
  a->side.rewind(to);
  log.rewind(to, b ? b->side.steps_taken() : -1);
  ++version;
  for (ShownSide* shown : {a.get(), b.get()}) {
    if (!shown) continue;
    shown->told_steps = shown->side.steps_taken();
    tell(steps_message(*shown, shown->told_steps));
    tell(pins_message(*shown));
  }
}

void Session::Impl::set_speed(Arguments& arguments) {
  const double value = arguments.number("value");
  arguments.finish();
  if (!(value >= 1e-9 && value <= 1e9)) refuse("speed.value", value, "a number from 1e-9 to 1e9 is expected");
  speed = value;
}

// ---------------------------------------------------------------- what is simulated

void Session::Impl::set(Arguments& arguments) {
  const std::string key = arguments.text("key", 200);
  const Json value = arguments.value("value");
  const bool has_side = arguments.has("side");
  ShownSide* only = has_side ? &side_of(arguments) : nullptr;
  arguments.finish();
  const auto is_compared = [&] {  // what the sides differ in stays different
    if (!comparison) return false;
    return std::any_of(comparison->overrides.begin(), comparison->overrides.end(),
                       [&](const std::string& o) { return key_of(o) == key; });
  };
  struct Prepared {
    ShownSide& shown;
    Side::Change change;
  };
  std::vector<Prepared> prepared;
  Busy busy(options);
  for (ShownSide* shown : {a.get(), b.get()}) {
    if (!shown || (only && only != shown)) continue;
    if (!only && shown == b.get() && is_compared()) continue;
    const std::string override_text = setting_override(shown->side.steered().document, key, value);
    prepared.push_back({*shown, shown->side.prepared(override_text, busy.announce())});
  }
  for (Prepared& p : prepared) {
    p.shown.side.apply(std::move(p.change));
    tell(scene_message(p.shown, field));
  }
  ++version;
  Json done = {{"do", "set"}, {"key", key}, {"value", value}};
  if (only) done["side"] = only->name;
  note(std::move(done));
}

void Session::Impl::load(Arguments& arguments) {
  const std::string path = arguments.text("scene");
  const std::vector<std::string> overrides =
      arguments.has("overrides") ? arguments.texts("overrides") : std::vector<std::string>{};
  arguments.finish();
  install(loaded("a", path, overrides), nullptr, std::nullopt);
}

void Session::Impl::lesson(Arguments& arguments) {
  const std::string id = arguments.text("lesson", 200);
  arguments.finish();
  std::vector<std::string> known;
  const Lesson* lesson = nullptr;
  for (const Lesson& candidate : options.lessons) {
    known.push_back(candidate.id);
    if (candidate.id == id) lesson = &candidate;
  }
  if (!lesson) throw InvalidInput(fmt::format("no lesson '{}'{}", id, suggestion(id, known)));
  if (!lesson->missing.empty()) throw InvalidInput(lesson->missing);
  if (lesson->scene.empty()) return;  // its panel needs none
  std::optional<Recording> recording;
  if (lesson->recording) recording = read_recording(parse_json(lesson->recording(), size_t{32} << 20));
  auto first = loaded("a", lesson->scene, lesson->overrides);
  std::unique_ptr<ShownSide> second;
  std::optional<Recording::Comparison> compared;
  if (!lesson->comparison.empty()) {
    compared = {lesson->comparison.front().overrides, lesson->comparison.front().label};
    std::vector<std::string> overrides = lesson->overrides;
    overrides.insert(overrides.end(), compared->overrides.begin(), compared->overrides.end());
    second = loaded("b", lesson->scene, overrides);
  }
  install(std::move(first), std::move(second), std::move(compared));
  if (recording) start_replay(*std::move(recording));
}

void Session::Impl::compare(Arguments& arguments) {
  Recording::Comparison compared{arguments.texts("overrides"), arguments.text("label", 200)};
  arguments.finish();
  const SteeredScene& steered = a->side.steered();
  std::vector<std::string> overrides = steered.overrides;
  for (const std::string& text : compared.overrides) overrides = with_override(std::move(overrides), text);
  auto second = loaded("b", steered.path, overrides);
  install(loaded("a", steered.path, steered.overrides), std::move(second), std::move(compared));
}

void Session::Impl::end_compare(Arguments& arguments) {
  arguments.finish();
  if (!b) throw InvalidInput("nothing is being compared");
  b.reset();
  comparison.reset();
  log.forget_side_b();
  a->label.clear();
  ++version;
  tell(text({{"kind", "end_compare"}}));
  tell(scene_message(*a, field));
}

// ---------------------------------------------------------------- mouse and pins

// Both sides are grabbed at the same point. What is recorded is the point of side a, whichever was touched.
void Session::Impl::grab(Arguments& arguments) {
  ShownSide& touched = side_of(arguments);
  const int triangle = arguments.integer("triangle", 0, touched.surface.triangle_count() - 1);
  SurfacePoint point{triangle, weights_of(arguments)};
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
  ++version;
  note({{"do", "pin"}, {"side", "a"}, {"vertices", vertices}, {"pinned", pinned}});
}

// ---------------------------------------------------------------- what is shown

void Session::Impl::colour(Arguments& arguments) {
  const std::string name = arguments.text("field", 100);
  arguments.finish();
  std::vector<std::string> known;
  for (const Field& f : fields_of(a->side.model())) known.push_back(f.name);
  if (!name.empty() && std::find(known.begin(), known.end(), name) == known.end())
    throw InvalidInput(fmt::format("no field '{}'{}", name, suggestion(name, known)));
  field = name;
  ++version;
  for (const ShownSide* shown : {a.get(), b.get()})
    if (shown) tell(scene_message(*shown, field));
}

void Session::Impl::surface(Arguments& arguments) {
  const std::string which = arguments.text("which", 20);
  arguments.finish();
  if (which != "skin" && which != "cage") refuse("surface.which", which, "'skin' or 'cage' is expected");
  wants_skin = which == "skin";
  ++version;
  for (ShownSide* shown : {a.get(), b.get()}) {
    if (!shown) continue;
    show_surface(*shown);
    tell(scene_message(*shown, field));
    tell(geometry_message(*shown));
    tell(pins_message(*shown));
  }
  note({{"do", "surface"}, {"which", which}});
}

// ---------------------------------------------------------------- what was done

void Session::Impl::note(Json done) {
  ++version;
  log.add({a->side.steps_taken() + 1, b ? b->side.steps_taken() : -1, std::move(done)});
}

void Session::Impl::replay(Arguments& arguments) {
  Recording recording = read_recording(arguments.value("recording"));
  arguments.finish();
  auto first = loaded("a", recording.scene, recording.overrides);
  std::unique_ptr<ShownSide> second;
  if (recording.compare) {
    std::vector<std::string> overrides = recording.overrides;
    for (const std::string& text : recording.compare->overrides) overrides = with_override(std::move(overrides), text);
    second = loaded("b", recording.scene, overrides);
  }
  install(std::move(first), std::move(second), recording.compare);
  start_replay(std::move(recording));
}

void Session::Impl::start_replay(Recording recording) {
  replaying = {std::move(recording)};
  playing = true;
}

void Session::Impl::repeat_due_events() {
  const std::vector<Event>& events = replaying->recording.events;
  while (replaying && replaying->next < events.size()) {
    const Event event = events[replaying->next];
    const int step = a->side.steps_taken() + 1;
    const bool is_due = event.step < step || (event.step == step && (!b || b->side.steps_taken() >= event.b));
    if (!is_due) return;
    ++replaying->next;
    const std::string what = event.command.at("do").get<std::string>();
    Arguments arguments(event.command, what);
    arguments.value("do");
    (this->*commands().at(what).carry_out)(arguments);
  }
}

// What is left to do are neither steps nor events that were carried out after the last one.
bool Session::Impl::is_replay_done() {
  if (a->side.steps_taken() < replaying->recording.steps && !a->side.is_blown_up()) return false;
  if (b && &next() == b.get()) return false;
  repeat_due_events();
  return true;
}

}  // namespace aspic::viewer
