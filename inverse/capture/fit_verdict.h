// Verdict on the reliability of a fitted material, for the command line, the JSON file and the page.
#pragma once
#include <string>
#include <vector>

#include "capture/fit_run.h"

namespace aspic {

struct FitVerdict {
  std::vector<FitReason> reasons;  // reasons against the material; empty: the verdict is good
  std::string text;                // a sentence

  bool is_good() const { return reasons.empty(); }
};

// Names of the reasons: interrupted, not_converged, mesh_not_settled, mesh_too_coarse, at_bound, group_missed,
// held_out_worse, groups_disagree, unexplained, predicts_badly, field_rejected,
// relaxation_failed, relaxation_undetermined, relaxation_unexplained.
FitVerdict verdict(const DataSet& data, const FitOutcome& outcome);

// Reasons why one value is better than a field: mesh_not_settled, at_bound, group_missed, held_out_worse.
std::vector<FitReason> reasons_against_field(const DataSet& data, const FitOutcome& outcome);

}  // namespace aspic
