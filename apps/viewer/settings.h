// What can be changed while a simulation runs: keys of a scene, with the words and choices of its schema.
#pragma once
#include <string>
#include <vector>

#include "scene/value.h"
#include "viewer/arguments.h"

namespace aspic::viewer {

// Of a complete document: the settings of web/src/protocol.ts.
Json settings_json(const Table& document);

// The override that gives a setting a new value: "material.young=2e5". Throws InvalidInput for a key that is no
// setting of the document and for values that no scene could hold; others are left to the schema.
std::string setting_override(const Table& document, const std::string& key, const Json& value);

// The key, checked, for a change that drops its override. Throws InvalidInput for a key that is no setting.
std::string setting_key(const std::string& key);

std::string key_of(const std::string& override_text);  // "material.young"

// The overrides with another one in place of that of the same key; a key alone only drops that one.
std::vector<std::string> with_override(std::vector<std::string> overrides, const std::string& override_text);

}  // namespace aspic::viewer
