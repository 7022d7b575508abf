// Prints the results of a fit as text.
#pragma once
#include <cstdio>
#include <string>

#include "pipeline/fit_verdict.h"

namespace aspic::cli {

void print_fit(std::FILE* stream, const DataSet& data, const FitOutcome& outcome);

// "176 vertices, 540 quadratic tets", without mid-edge nodes
std::string mesh_text(const TetMesh& mesh);

// "forces within 4 % of the largest force (limit 10 %)". `limits`: multiple of the limits; 0: without limits.
std::string errors_text(const PredictionErrors& errors, double limits);

// "12.3 kPa"
std::string value_text(double value, const std::string& unit);

}  // namespace aspic::cli
