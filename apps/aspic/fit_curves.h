// Fits materials to curves of homogeneous deformation, from a table of them, for people.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "fit/curve_fit.h"

namespace aspic::cli {

struct CurveFitRequest {
  std::vector<std::filesystem::path> files;  // tables, see capture/test_curves.h
  std::vector<std::string> materials;        // each is fitted to each table
  std::vector<std::string> tests;            // of each table, those that are fitted; empty: all
  CurveFitOptions options;
  std::filesystem::path picture;  // measured against fitted; empty: none
  bool table = false;             // Markdown instead of a report per fit
  bool json = false;
  std::filesystem::path published;  // a table of errors that others published, to be compared with; empty: none
};

// The exit code. Throws InvalidInput.
int fit_curves(const CurveFitRequest& request);

}  // namespace aspic::cli
