// Fitted relaxation times on the terminal, as JSON, and as files of the folder of a fit.
#pragma once
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "estimate/relaxation_fit.h"

namespace aspic::cli {

void print_relaxation(std::FILE* stream, const RelaxationFit& fit);
nlohmann::ordered_json json_of(const RelaxationFit& fit);
// Writes viscoelastic.toml and relaxation.csv; with gnuplot relaxation.svg for forces and creep.svg for motions.
void write_relaxation(const std::filesystem::path& folder, const RelaxationFit& fit);

}  // namespace aspic::cli
