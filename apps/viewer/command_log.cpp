#include "viewer/command_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "base/error.h"

namespace aspic::viewer {
namespace {

bool does(const Event& event, const char* what) { return event.command.at("do") == what; }

// Key of the value that a command sets. A later command with the same key replaces it. Empty: none.
std::string meaning(const Event& event) {
  for (const char* lasting : {"stiffness", "surface"})
    if (does(event, lasting)) return lasting;
  if (!does(event, "set")) return {};
  return event.command.at("key").get<std::string>() + " " + event.command.value("side", "");
}

Event read_event(const Json& json) {
  Arguments arguments(json, "event");
  Event event;
  event.step = arguments.integer("step", 1, std::numeric_limits<int>::max());
  if (arguments.has("b")) event.b = arguments.integer("b", 0, std::numeric_limits<int>::max());
  event.command = arguments.value("command");
  arguments.finish();
  if (!event.command.is_object() || !event.command.contains("do") || !event.command["do"].is_string())
    refuse("event.command", event.command, "a command is expected, such as {\"do\": \"release\"}");
  for (const char* known : {"set", "grab", "move", "release", "stiffness", "pin", "surface", "touch", "press", "lift"})
    if (event.command["do"] == known) return event;
  refuse("event.command", event.command,
         "set, grab, move, release, stiffness, pin, surface, touch, press or lift is expected");
}

}  // namespace

Json to_json(const Recording& recording) {
  Json events = Json::array();
  for (const Event& event : recording.events) {
    Json json = {{"step", event.step}, {"command", event.command}};
    if (event.b >= 0) json["b"] = event.b;
    events.push_back(std::move(json));
  }
  Json compare;
  if (recording.compare) compare = {{"overrides", recording.compare->overrides}, {"label", recording.compare->label}};
  return {{"scene", recording.scene},
          {"overrides", recording.overrides},
          {"compare", std::move(compare)},
          {"events", std::move(events)},
          {"steps", recording.steps}};
}

Recording read_recording(const Json& json) {
  Arguments arguments(json, "recording");
  Recording recording{.scene = arguments.text("scene"), .overrides = arguments.texts("overrides")};
  if (const Json& compare = arguments.value("compare"); !compare.is_null()) {
    Arguments inner(compare, "recording.compare");
    recording.compare = {inner.texts("overrides"), inner.text("label", 200)};
    inner.finish();
  }
  recording.steps = arguments.integer("steps", 0, std::numeric_limits<int>::max());
  const Json& events = arguments.value("events");
  if (!events.is_array() || events.size() > CommandLog::kMaxEvents)
    refuse("recording.events", events, fmt::format("at most {} events are expected", CommandLog::kMaxEvents));
  for (const Json& event : events) recording.events.push_back(read_event(event));
  arguments.finish();
  if (!std::is_sorted(recording.events.begin(), recording.events.end(),
                      [](const Event& a, const Event& b) { return a.step < b.step; }))
    throw InvalidInput("recording.events: their steps must not decrease");
  return recording;
}

void CommandLog::add(Event event) {
  // Only the last move between two steps has an effect.
  for (const char* what : {"move", "press"})
    if (does(event, what) && !events_.empty() && does(events_.back(), what) && events_.back().step == event.step &&
        events_.back().b == event.b)
      events_.pop_back();
  if (events_.size() >= kMaxEvents) {
    is_complete_ = false;
    return;
  }
  events_.push_back(std::move(event));
}

void CommandLog::rewind(int step, int b) {
  const auto undone = std::find_if(events_.begin(), events_.end(), [&](const Event& e) { return e.step > step + 1; });
  std::vector<Event> again;
  for (auto event = events_.end(); event != undone;) {
    --event;
    const std::string what = meaning(*event);
    if (what.empty() || std::any_of(again.begin(), again.end(), [&](const Event& e) { return meaning(e) == what; }))
      continue;
    again.push_back({step + 1, b, event->command});
  }
  events_.erase(undone, events_.end());
  for (auto event = again.rbegin(); event != again.rend(); ++event) add(*event);
}

void CommandLog::forget_side_b() {
  std::erase_if(events_, [](const Event& event) { return event.command.value("side", "") == "b"; });
  for (Event& event : events_) event.b = -1;
}

}  // namespace aspic::viewer
