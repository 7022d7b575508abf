// Examines a data set before a fit.
#pragma once
#include <filesystem>
#include <optional>

#include "data/registration.h"

namespace aspic::cli {

struct CheckDataOptions {
  std::filesystem::path charts;  // folder of the charts; empty: "check" in the data set
  bool json = false;             // print findings as JSON on standard output
  std::optional<RegistrationKind> registers = {};
};

// Prints contents and suspicious values, and draws force over depth and the motion of markers. Returns the exit code
// (bad input if there are errors). Throws InvalidInput if the data cannot be read.
int check_data(const std::filesystem::path& data, const CheckDataOptions& options = {});

}  // namespace aspic::cli
