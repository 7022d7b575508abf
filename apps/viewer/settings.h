// The settings that can change during a simulation: keys of a scene with the help texts and choices of its schema.
#pragma once
#include <string>
#include <vector>

#include "scene/value.h"
#include "viewer/arguments.h"

namespace aspic::viewer {

// Returns the settings of web/src/protocol.ts. Requires a complete document.
Json settings_json(const Table& document);

// Returns the override of a setting: "material.young=2e5". Throws InvalidInput for a key that is not a setting of the
// document and for values that TOML cannot represent. The schema validates all others.
std::string setting_override(const Table& document, const std::string& key, const Json& value);

// Returns the key of an override to drop. Throws InvalidInput if the key is not a setting.
std::string setting_key(const std::string& key);

std::string key_of(const std::string& override_text);  // "material.young"

// Replaces the override of the same key. A key alone drops its override.
std::vector<std::string> with_override(std::vector<std::string> overrides, const std::string& override_text);

}  // namespace aspic::viewer
