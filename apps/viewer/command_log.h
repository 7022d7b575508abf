// The commands of a session with their steps. A replay of them is bit-reproducible.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "viewer/arguments.h"

namespace aspic::viewer {

struct Event {   // NOLINT(bugprone-exception-escape): a move of JSON does not throw
  int step = 1;  // step of side a that follows the command
  int b = -1;    // number of steps of side b before the command; -1: no side b
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
Recording read_recording(const Json& json);  // throws InvalidInput; the replay validates the commands

class CommandLog {
 public:
  static constexpr size_t kMaxEvents = 100'000;

  void clear() { events_.clear(), is_complete_ = true; }
  void add(Event event);
  // Drops the commands after a step of side a. Settings and the stiffness of the mouse keep their values: the latest
  // commands that set them move to that step.
  void rewind(int step, int b);
  void forget_side_b();
  const std::vector<Event>& events() const { return events_; }
  bool is_complete() const { return is_complete_; }  // false: more than kMaxEvents

 private:
  std::vector<Event> events_;
  bool is_complete_ = true;
};

}  // namespace aspic::viewer
