// "--set material.young=2e5": values from the command line that replace those of the document before it is checked.
#pragma once
#include <string>

#include "scene/value.h"

namespace aspic {

// The path starts at the top level ("time.step") or at the keys of a body, then of all bodies ("material.young").
// In a list of tables the next word picks by name or by index from 0 ("body.bunny.pin.0.where"); otherwise all are
// meant. The value is TOML; what is not is a string ("solver.method=newton"). Throws InvalidInput.
void apply_override(Table& document, const std::string& text);

// The name of a body as it will be: given, or the stem of its mesh file, or body1, body2, ...
std::string body_name(const Table& body, size_t index);

}  // namespace aspic
