// The commands by name, and those about time and about what is shown.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "base/error.h"
#include "viewer/session_impl.h"

namespace aspic::viewer {
namespace {

constexpr int kMostCatchingUp = 100'000;  // steps of side b for one of side a

}  // namespace

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
                                                       {"touch", {&Impl::touch}},
                                                       {"press", {&Impl::press}},
                                                       {"lift", {&Impl::lift}},
                                                       {"bench", {&Impl::set_bench, false}},
                                                       {"record", {&Impl::record, false}},
                                                       {"poke_all", {&Impl::poke_all, false}},
                                                       {"forget", {&Impl::forget, false}},
                                                       {"save_capture", {&Impl::save_capture, false}},
                                                       {"fit", {&Impl::fit, false}},
                                                       {"stop_fit", {&Impl::stop_fit, false}},
                                                       {"simulate_fit", {&Impl::simulate_fit}},
                                                       {"compare", {&Impl::compare}},
                                                       {"end_compare", {&Impl::end_compare}},
                                                       {"color", {&Impl::color, false}},
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
    progress = shown.side.iterate(stop_token());
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

// ---------------------------------------------------------------- what is shown

void Session::Impl::color(Arguments& arguments) {
  const std::string name = arguments.text("field", 100);
  arguments.finish();
  std::vector<std::string> known;
  for (const Field& f : a->side.fields()) known.push_back(f.name);
  if (!name.empty() && !a->side.has_field(name))
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

}  // namespace aspic::viewer
