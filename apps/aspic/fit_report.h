// The page that a fit leaves beside its material; written by what the program was built with.
#pragma once
#include <cstdio>
#include <filesystem>

#include "capture/fit_run.h"

namespace aspic::cli {

// Says on `stream`, unless that is null, where it is or why there is none.
void write_fit_report(const std::filesystem::path& file, const DataSet& data, const FitOutcome& outcome,
                      const std::vector<FitIteration>& history, std::FILE* stream);

}  // namespace aspic::cli
