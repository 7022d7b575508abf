#include "pipeline/left_out.h"

#include "pipeline/fit_troubles.h"

namespace aspic {

Measured left_out_cases(const DataSet& data, const FitPlan& plan) {
  return subset(data.experiment, [&](const LoadCase& c) { return is_left_out(plan.left_out, c); });
}

HeldOut compare_held_out(const DataSet& data, const FitOutcome& outcome) {
  const Measured left_out = left_out_cases(data, outcome.plan);
  std::vector<CasePrediction> predictions;
  for (const CaseOutcome& c : outcome.cases) {
    if (!c.left_out) continue;
    if (!c.ok) return {.failure = "a group could not be predicted"};
    CasePrediction& prediction = predictions.emplace_back();
    prediction.markers = c.markers;
    prediction.wrench = c.wrench;
  }
  if (predictions.empty() || predictions.size() != left_out.cases.size()) return {.failure = "no group was predicted"};
  return compare(left_out, predictions);
}

}  // namespace aspic
