// Options of `aspic fit` in a TOML file.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/fit_plan.h"

namespace aspic::cli {

inline constexpr const char* kFitOptionsFile = "aspic.fit.toml";

// Returns `given`, or else the options file in the folder of the data set; empty if there is none.
std::filesystem::path options_of(const std::filesystem::path& data, const std::filesystem::path& given);

// Reads the file into the plan; without a file, the defaults. Throws InvalidInput with file, line, value and remedy.
void read_fit_options(const std::filesystem::path& file, FitPlan& plan);

struct OptionOrigin {
  std::string option, place;  // "smooth", "pillow/aspic.fit.toml:3" or "default"
};
std::vector<OptionOrigin> fit_option_origins(const std::filesystem::path& file);  // all keys of an options file

// Returns all keys with their defaults and meanings, as a TOML file.
std::string fit_options_text();

}  // namespace aspic::cli
