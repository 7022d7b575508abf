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
// Checks a document that was not read from text, and fills in the defaults. Throws InvalidInput.
void complete_scene_document(Table& document, const std::string& source);

}  // namespace aspic
