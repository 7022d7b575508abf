// The messages of a session that are text.
#pragma once
#include "viewer/command_log.h"
#include "viewer/session.h"
#include "viewer/side.h"

namespace aspic::viewer {

// A side as the page sees it.
struct ShownSide {
  std::string name = "a";
  std::string label;  // in a comparison
  Side side;
  Surface surface;
  uint32_t generation = 1;                                               // of its geometry
  int told_steps = 0;                                                    // whose rows the pages have
  std::vector<std::string> loaded_overrides = side.steered().overrides;  // before any setting was changed

  int number() const { return name == "a" ? 0 : 1; }
};

Message text(const Json& json);  // whatever bytes file names consist of
Message hello(const std::vector<Lesson>& lessons, Role role);
Message scene_message(const ShownSide& shown, const std::string& field);
Message geometry_message(const ShownSide& shown);
Message steps_message(const ShownSide& shown, int from);
Message pins_message(const ShownSide& shown);
Json state_of(const ShownSide& shown);
Message refusal(const Json& id, const std::string& why);

}  // namespace aspic::viewer
