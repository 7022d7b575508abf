// Figures of cases, groups and models of a fit as JSON, for figures.json and the report.
#pragma once
#include <nlohmann/json.hpp>

#include "commands/fit_figures.h"

namespace aspic::cli {

using Json = nlohmann::ordered_json;

Json cases_json(const DataSet& data, const FitOutcome& outcome);
// Largest error of each fitted group [standard deviations].
Json groups_json(const DataSet& data, const FitOutcome& outcome);
// Counts of residuals in equal bins of standard deviations; those beyond the limit are in the outermost bins.
Json histogram_json(const DataSet& data, const FitOutcome& outcome);
// Errors of each predicted group with their limits; null without any.
Json held_out_json(const DataSet& data, const FitOutcome& outcome);
// Errors of the fit and of one value per parameter for the same held-out groups, beyond the noise and relative to the
// peaks.
Json comparison_json(const DataSet& data, const FitOutcome& outcome);

}  // namespace aspic::cli
