// Prints the results of a fit as text.
#pragma once
#include <cstdio>
#include <string>

#include "capture/fit_run.h"

namespace aspic::cli {

void print_fit(std::FILE* stream, const DataSet& data, const FitOutcome& outcome);

// "12.3 kPa"
std::string value_text(double value, const std::string& unit);

}  // namespace aspic::cli
