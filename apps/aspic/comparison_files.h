// Output of `aspic compare`: tables, pictures and a page.
#pragma once
#include <filesystem>

#include "aspic/comparison.h"

namespace aspic::cli {

// Writes methods.csv, work.csv, comparison.json, iterations.svg, time.svg, index.html to an existing folder. Without
// gnuplot it omits pictures and returns the reason, else an empty text. Throws InvalidInput if writing fails.
std::string write_comparison(const std::filesystem::path& folder, const std::string& scene,
                             const Comparison& comparison);

}  // namespace aspic::cli
