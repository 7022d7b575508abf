// Options of `aspic fit` in a TOML file.
#pragma once
#include <filesystem>
#include <string>

#include "capture/fit_plan.h"

namespace aspic::cli {

// Reads the file into the plan; without a file, the defaults. Returns whether baselines predict the held-out groups.
// Throws InvalidInput with file, line, value and remedy.
bool read_fit_options(const std::filesystem::path& file, FitPlan& plan);

// Returns all keys with their defaults and meanings, as a TOML file.
std::string fit_options_text();

}  // namespace aspic::cli
