// How good a fit is, in numbers: against the truth of synthetic data, and on groups that were left out.
#pragma once
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "capture/fit_verdict.h"
#include "capture/judge.h"

namespace aspic::cli {

struct Prediction {
  std::string method;  // "fit", "one modulus", "per-example linear", "bickel"
  HeldOut held_out;    // all groups that were left out, together
};

struct FitFigures {
  std::vector<Judgment> judgments;      // empty: the data have no truth
  std::vector<Prediction> predictions;  // empty: nothing was left out
};

// `truth`: a file; when there is none, nothing is judged. Baselines are fitted to the same data.
FitFigures figures_of(const DataSet& data, const FitOutcome& outcome, const std::filesystem::path& truth,
                      bool with_baselines);
void print_figures(std::FILE* stream, const FitFigures& figures);
void write_figures(const std::filesystem::path& file, const FitOutcome& outcome, const FitVerdict& judged,
                   const FitFigures& figures);

}  // namespace aspic::cli
