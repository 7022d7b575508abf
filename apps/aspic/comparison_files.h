// What `aspic compare` leaves in its folder: tables, pictures and a page that shows them.
#pragma once
#include <filesystem>

#include "aspic/comparison.h"

namespace aspic::cli {

// methods.csv, work.csv, comparison.json, iterations.svg, time.svg, index.html. Without gnuplot the pictures are left
// out; returns why, or an empty text. Throws InvalidInput when the folder cannot be written.
std::string write_comparison(const std::filesystem::path& folder, const std::string& scene,
                             const Comparison& comparison);

}  // namespace aspic::cli
