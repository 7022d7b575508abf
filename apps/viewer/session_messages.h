// The messages of a session, and the side of a comparison that they show.
#pragma once
#include "viewer/fields.h"
#include "viewer/session.h"
#include "viewer/side.h"

namespace aspic::viewer {

// A side as the pages display it.
struct ShownSide {
  std::string name = "a";
  std::string label;  // label in a comparison
  Side side;
  Surface surface = {};
  uint32_t generation = 1;                                               // generation of the geometry
  int sent_steps = 0;                                                    // number of steps whose rows were sent
  std::vector<std::string> loaded_overrides = side.steered().overrides;  // before any change of settings
  bool offers_mesh_error = false;                                        // in the last message "scene"

  int number() const { return name == "a" ? 0 : 1; }
  std::vector<Field> fields() const { return fields_of(side.model(), !side.mesh_error().empty()); }
  bool has_field(const std::string& field) const;
  View view() const { return {side.simulation(), side.positions(), side.mesh_error()}; }
};

Message text(const Json& json);  // replaces invalid UTF-8, as in file names
Message hello(const std::vector<Lesson>& lessons, Role role);
Message scene_message(const ShownSide& shown, const std::string& field);
Message geometry_message(const ShownSide& shown);
Message obstacles_message(const ShownSide& shown);
Message steps_message(const ShownSide& shown, int from);
Message pins_message(const ShownSide& shown);
Message fibres_message(const ShownSide& shown);
Json state_of(const ShownSide& shown);
Message refusal(const Json& id, const std::string& why, bool is_interrupted = false);

}  // namespace aspic::viewer
