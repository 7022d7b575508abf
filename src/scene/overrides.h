// Values of the command line ("--set material.young=2e5"), which replace those of the document before it is checked.
#pragma once
#include <string>
#include <vector>

#include "scene/value.h"

namespace aspic {

// The path starts at the top level ("time.step") or at the keys of a body, which then apply to all bodies
// ("material.young"). In a list of tables, the next word selects by name or by index from 0 ("body.bunny.pin.0.where");
// without one, all are selected. A value that is not TOML is a string ("solver.method=newton"). Throws InvalidInput.
void apply_override(Table& document, const std::string& text);

// For arguments of a program: inserts --set before each further KEY=VALUE, so that `--set A=1 B=2` becomes
// `--set A=1 --set B=2`. The name of an existing file is no assignment. Numbers such as -.5, which look like
// options, become -0.5.
std::vector<std::string> spread_assignments(const std::vector<std::string>& arguments);

// Returns the name of a body: given, or the stem of its mesh file, or body1, body2, ...
std::string body_name(const Table& body, size_t index);

}  // namespace aspic
