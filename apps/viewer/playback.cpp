#include "viewer/playback.h"

#include <algorithm>

namespace aspic::viewer {
namespace {

constexpr int kMaxCatchingUp = 100'000;  // maximum number of steps of side b per step of side a

}  // namespace

Playback::Playback(Stage& stage, Commands& commands, std::function<bool()> wants_stop)
    : stage_(stage), commands_(commands), wants_stop_(std::move(wants_stop)) {
  commands["play"] = {plain([this] { is_playing_ = true; }), false};
  commands["pause"] = {plain([this] { is_playing_ = false; }), false};
  commands["step"] = {plain([this] { step(); }), false};
  commands["iterate"] = {plain([this] { iterate(); }), false};
  commands["speed"] = {[this](Arguments& a) { set_speed(a); }, false};
  commands["reset"] = {plain([this] { rewind_to(0); })};
  commands["rewind"] = {[this](Arguments& a) {
    const int to = a.integer("step", 0, stage_.a().side.steps_taken());
    a.finish();
    rewind_to(to);
  }};
}

StopToken Playback::stop_token() const {
  return StopToken(
      [this] { return is_interrupted_.load(std::memory_order_relaxed) || (wants_stop_ && wants_stop_()); });
}

void Playback::send_state() {
  stage_.send_new_fields();
  Json state = {{"kind", "state"},
                {"playing", is_playing_},
                {"speed", speed_},
                {"rate", is_playing_ ? rate_ : 0},
                {"replaying", is_replaying()},
                {"b", nullptr}};
  for (ShownSide& shown : stage_.sides()) {
    const int taken = shown.side.steps_taken();
    if (shown.sent_steps < taken) stage_.send(steps_message(shown, std::exchange(shown.sent_steps, taken)));
    state[shown.name] = state_of(shown);
  }
  stage_.send(text(state));
}

void Playback::install(std::vector<ShownSide> sides, std::optional<Recording::Comparison> comparison,
                       std::optional<Recording> recording) {
  end_replay();
  is_playing_ = false;
  stage_.install(std::move(sides), std::move(comparison));
  send_state();
  if (!recording) return;
  replayed_ = {*std::move(recording)};
  is_playing_ = true;
}

// ---------------------------------------------------------------- steps

void Playback::move(ShownSide& shown, Progress (Side::*by)(const StopToken&)) {
  Progress progress = Progress::interrupted;
  try {
    progress = (shown.side.*by)(stop_token());
  } catch (...) {
    shown.side.rewind(shown.side.steps_taken());
    throw;
  }
  if (progress == Progress::interrupted) return;
  stage_.mark_changed();
  if (progress == Progress::blown_up && stage_.next().side.is_blown_up()) is_playing_ = false;
}

void Playback::take_turn() {
  if (replayed_) repeat_due_events();
  move(stage_.next(), &Side::step);
}

void Playback::advance(const std::function<bool()>& is_next_due) {
  allow();
  if (!is_playing_) return;
  try {
    do {
      take_turn();
      if (replayed_ && is_replay_done()) {
        end_replay();
        is_playing_ = false;
      }
    } while (is_playing_ && is_next_due && is_next_due());
  } catch (const std::exception& e) {
    is_playing_ = false;
    end_replay();
    stage_.send(refusal(nullptr, e.what()));
  }
  send_state();
}

void Playback::step() {
  is_playing_ = false;
  const ShownSide& first = stage_.next();
  const int before = first.side.steps_taken();
  take_turn();
  for (int k = 0; stage_.b() && &stage_.next() == stage_.b() && !is_interrupted_ && k < kMaxCatchingUp; ++k) {
    if (first.side.steps_taken() == before) break;  // interrupted
    take_turn();
  }
}

void Playback::iterate() {
  is_playing_ = false;
  if (replayed_ && stage_.a().side.iteration() < 0) repeat_due_events();
  move(stage_.next(), &Side::iterate);
}

void Playback::set_speed(Arguments& arguments) {
  const double value = arguments.number("value");
  arguments.finish();
  if (!(value >= 1e-9 && value <= 1e9)) refuse("speed.value", value, "a number from 1e-9 to 1e9 is expected");
  speed_ = value;
}

// Two sides return to the latest time of which both have a snapshot.
void Playback::rewind_to(int step) {
  is_playing_ = false;
  Side& a = stage_.a().side;
  const Timeline& timeline = a.history().timeline();
  int to = timeline.nearest(step).step;
  if (stage_.b()) {
    Side& b = stage_.b()->side;
    const double h = std::min(a.simulation().options().h, b.simulation().options().h);
    const Snapshot* other = nullptr;
    while (!(other = b.history().timeline().at_time(timeline.nearest(to).state.time, 1e-6 * h)) && to > 0)
      to = timeline.nearest(to - 1).step;
    b.rewind(other ? other->step : 0);
  }
  a.rewind(to);
  stage_.rewind_record();
  for (ShownSide& shown : stage_.sides()) {
    shown.sent_steps = shown.side.steps_taken();
    stage_.send(steps_message(shown, shown.sent_steps));
    stage_.send(pins_message(shown));
  }
}

// ---------------------------------------------------------------- replay

void Playback::repeat_due_events() {
  const std::vector<Event>& events = replayed_->recording.events;
  while (replayed_ && replayed_->next < events.size()) {
    const Event event = events[replayed_->next];
    const int step = stage_.a().side.steps_taken() + 1;
    const ShownSide* b = stage_.b();
    const bool is_due = event.step < step || (event.step == step && (!b || b->side.steps_taken() >= event.b));
    if (!is_due) return;
    ++replayed_->next;
    const std::string name = event.command.at("do");
    Arguments arguments(event.command, name);
    arguments.value("do");
    commands_.at(name).carry_out(arguments);
  }
}

// Also repeats the events after the last step.
bool Playback::is_replay_done() {
  const Side& a = stage_.a().side;
  if (a.steps_taken() < replayed_->recording.steps && !a.is_blown_up()) return false;
  if (stage_.b() && &stage_.next() == stage_.b()) return false;
  repeat_due_events();
  return true;
}

}  // namespace aspic::viewer
