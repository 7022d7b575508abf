// Accuracy of a fit: errors relative to the truth of synthetic data, and predictions of held-out groups.
#pragma once
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "capture/fit_verdict.h"
#include "capture/judge.h"

namespace aspic::cli {

struct Prediction {
  std::string method;  // "fit", "one modulus", "per-example linear", "bickel"
  HeldOut held_out;    // all held-out groups together
};

struct FitFigures {
  std::vector<Judgment> judgments;      // empty: the data have no truth
  std::vector<Prediction> predictions;  // empty: no held-out groups
};

// `truth` is a file; without it there are no judgments. Baselines are fitted to the same data.
FitFigures figures_of(const DataSet& data, const FitOutcome& outcome, const std::filesystem::path& truth,
                      bool with_baselines);
void print_figures(std::FILE* stream, const DataSet& data, const FitFigures& figures);
// Text of figures.json, whose numbers the report shows.
std::string figures_json(const DataSet& data, const FitOutcome& outcome, const FitVerdict& judged,
                         const FitFigures& figures);

}  // namespace aspic::cli
