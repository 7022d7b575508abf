// Reads and completes the text of a scene.
#pragma once
#include <string>
#include <vector>

#include "scene/value.h"

namespace aspic {

// Reads TOML, applies the overrides, checks against the schema and fills in the defaults. `source`: file name for
// messages. Throws InvalidInput.
Table read_scene_document(const std::string& text, const std::string& source,
                          const std::vector<std::string>& overrides = {});

}  // namespace aspic
