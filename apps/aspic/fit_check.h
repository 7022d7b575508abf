// What a data set says before anything is fitted.
#pragma once
#include <filesystem>

namespace aspic::cli {

struct CheckDataOptions {
  std::filesystem::path charts;  // the folder of the charts; empty: "check" in the data set
  bool json = false;             // findings as JSON on standard output
};

// Prints what was read and what is odd about it, and draws force against depth and the motions of markers. Returns the
// exit code: bad input where there are errors. Throws InvalidInput for data that cannot be read.
int check_data(const std::filesystem::path& data, const CheckDataOptions& options = {});

}  // namespace aspic::cli
