// The table of the commands and questions of a page. apps/viewer/protocol.md describes them.
#pragma once
#include <functional>
#include <map>
#include <string>

#include "base/error.h"
#include "viewer/arguments.h"

namespace aspic {
struct Model;
class StopToken;
}  // namespace aspic

namespace aspic::viewer {

class Playback;
class Stage;
struct SessionOptions;
struct Surface;

// A command interrupted a question, which may be repeated.
class Interrupted : public InvalidInput {
  using InvalidInput::InvalidInput;
};

struct Command {
  std::function<void(Arguments& arguments)> carry_out;  // throws InvalidInput
  bool takes_over = true;                               // changes the physics, which ends a replay
};
// The function of a command without members.
template <class Act>
std::function<void(Arguments&)> plain(Act act) {
  return [act](Arguments& arguments) { arguments.finish(), act(); };
}
using Commands = std::map<std::string, Command>;
using Questions = std::map<std::string, std::function<Json(Arguments& arguments)>>;

void add_hand_commands(Stage& stage, Commands& commands);  // grab, move, release, stiffness, pin
// set, load, lesson, compare, end_compare, replay, color, surface
void add_scene_commands(const SessionOptions& options, Stage& stage, Playback& playback, Commands& commands);
void add_questions(const SessionOptions& options, Stage& stage, const Playback& playback, Questions& questions);

}  // namespace aspic::viewer
