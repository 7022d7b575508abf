// What was done to a simulation, by step: enough to repeat it to the same bits.
#pragma once
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "viewer/arguments.h"

namespace aspic::viewer {

struct Event {   // NOLINT(bugprone-exception-escape): to move JSON throws nothing
  int step = 1;  // carried out before this step of side a
  int b = -1;    // and when side b had taken this number of steps; -1: no side b
  Json command;
};

struct Recording {
  std::string scene;
  std::vector<std::string> overrides;
  struct Comparison {
    std::vector<std::string> overrides;
    std::string label;
  };
  std::optional<Comparison> compare;
  std::vector<Event> events;
  int steps = 0;
};
Json to_json(const Recording& recording);
Recording read_recording(const Json& json);  // throws InvalidInput; the commands are looked at when it is their turn

class CommandLog {
 public:
  static constexpr size_t kMostEvents = 100'000;

  void clear() { events_.clear(), is_complete_ = true; }
  void add(Event event);
  // Side a went back to the end of a step, which undoes what was done after it. Settings and the stiffness of the
  // mouse stay as they are: what set them last is done again there.
  void rewind(int step, int b);
  void forget_side_b();
  const std::vector<Event>& events() const { return events_; }
  bool is_complete() const { return is_complete_; }  // not too many to be kept

 private:
  std::vector<Event> events_;
  bool is_complete_ = true;
};

}  // namespace aspic::viewer
