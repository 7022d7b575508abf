// What another library adds to a session: a tool that acts on the body beside the mouse, and commands, questions and
// messages. inverse/bench has the only one. Without it a session has the base class of the tool, which does nothing.
#pragma once
#include <functional>
#include <memory>
#include <span>

#include "viewer/commands.h"

namespace aspic::viewer {

struct Interval {
  double begin = 0, end = 0;  // [s]
};

// Motion of a tool between two places, of a type private to the tool; null: it does not act.
using ToolMotion = std::shared_ptr<const void>;

// A load on the body of one side that the commands touch, press and lift move. It rests between steps. Within a step
// it moves to its wanted place.
class SideTool {
 public:
  virtual ~SideTool() = default;
  virtual ToolMotion resting([[maybe_unused]] double time) const { return nullptr; }  // [s]
  virtual ToolMotion acting([[maybe_unused]] const Interval& step) const { return nullptr; }
  virtual void finish_step() {}  // rests at the wanted place
  // Moves the load. Throws InvalidInput if the body cannot have it, and then changes nothing.
  virtual void set([[maybe_unused]] const ToolMotion& motion) {}
  virtual void return_to([[maybe_unused]] const ToolMotion& resting) {}  // the wanted place is that of this motion
  // Takes over the places of the tool of the same body before a change of its settings. Throws InvalidInput.
  virtual void continue_from([[maybe_unused]] const SideTool& before) {}
  virtual double energy([[maybe_unused]] std::span<const double> x) const { return 0; }     // of the load [J]
  virtual Json state([[maybe_unused]] std::span<const double> x) const { return nullptr; }  // for the message "state"
};

// Part of a session that adds commands and questions at its construction.
class Desk {
 public:
  virtual ~Desk() = default;
  virtual void check_body() = 0;  // called after a change of scene, settings or pins
  virtual void send() const = 0;  // sends its state, also to a new page
};

struct SessionExtension {
  std::function<std::unique_ptr<SideTool>(Model& model)> make_tool;  // adds its load to the model; empty: none
  std::function<std::unique_ptr<Desk>(const SessionOptions& options, Stage& stage, Playback& playback,
                                      Commands& commands, Questions& questions)>
      make_desk;  // empty: none
};

}  // namespace aspic::viewer
