// Accuracy of a fit: errors relative to the truth of synthetic data, and predictions of held-out groups.
#pragma once
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "data/judge.h"
#include "pipeline/fit_verdict.h"

namespace aspic::cli {

struct FitFigures {
  std::vector<Judgment> judgments;  // empty: the data have no truth
  std::optional<HeldOut> left_out;  // prediction of all groups of `leave_out`; empty: there are none
};

// `truth` is a file; without it there are no judgments.
FitFigures figures_of(const DataSet& data, const FitOutcome& outcome, const std::filesystem::path& truth);
void print_figures(std::FILE* stream, const DataSet& data, const FitFigures& figures);
// Text of figures.json, whose numbers the report shows.
std::string figures_json(const DataSet& data, const FitOutcome& outcome, const FitVerdict& judged,
                         const FitFigures& figures);

}  // namespace aspic::cli
