// What was done is noted, and can be repeated.
#include "viewer/session_impl.h"

namespace aspic::viewer {

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
