// A fit as one self-contained HTML file: the viewer's page with measurements and results.
#pragma once
#include <string>
#include <vector>

#include "pipeline/fit_run.h"

namespace aspic::viewer {

struct FitPageContent {
  const DataSet& data;
  const FitOutcome& outcome;
  const std::vector<FitIteration>& history;  // in ascending order
  const std::string& figures;                // text of figures.json
};

std::string fit_page(const FitPageContent& content);

}  // namespace aspic::viewer
