// The fibres at a displayed surface.
#pragma once
#include "viewer/arguments.h"
#include "viewer/fields.h"
#include "viewer/surface.h"

namespace aspic::viewer {

bool has_fibres(const Model& model);

// Returns the lines of the message "fibres": a triangle and two shares of its edges for each.
Json fibre_lines(const Model& model, const Surface& surface);

}  // namespace aspic::viewer
