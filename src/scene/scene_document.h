// The text of a scene, checked and complete.
#pragma once
#include <string>
#include <vector>

#include "scene/value.h"

namespace aspic {

// Reads TOML, applies the overrides, checks against the schema and fills in the defaults. `source` is the file name of
// the messages. Throws InvalidInput.
Table read_scene_document(const std::string& text, const std::string& source,
                          const std::vector<std::string>& overrides = {});

}  // namespace aspic
