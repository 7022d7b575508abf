// Options of a fit: smoothness, weights, uncertainty, ...
#pragma once
#include <string>

#include "pipeline/fit_plan.h"
#include "scene/schema.h"

namespace aspic {

const Schema& fit_options_schema();  // its only section is "fit"

// Reads a document into the plan; keys that are missing have defaults. Throws InvalidInput with place, value and
// remedy.
void read_fit_options(Table document, const std::string& source, FitPlan& plan);

}  // namespace aspic
