#pragma once
#include <string>

namespace aspic {

// Returns the scene schema as JSON Schema, draft 7, with which editors complete and check scenes.
std::string scene_json_schema();

}  // namespace aspic
