// Fits materials to tables of homogeneous deformation curves and prints the results.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "fit/curve_fit.h"

namespace aspic::cli {

struct CurveFitRequest {
  std::vector<std::filesystem::path> files;  // tables, see capture/test_curves.h
  std::vector<std::string> materials;        // materials to fit to each table
  std::vector<std::string> tests;            // tests to fit in each table; empty: all
  CurveFitOptions options;
  std::filesystem::path picture;  // plot of measured and fitted curves; empty: none
  bool table = false;             // Markdown instead of a report per fit
  bool json = false;
  std::filesystem::path published;  // table of published errors to compare with; empty: none
};

// Returns the exit code. Throws InvalidInput.
int fit_curves(const CurveFitRequest& request);

}  // namespace aspic::cli
