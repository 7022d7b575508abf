// Verdict on the reliability of a fitted material, for the command line, the JSON file and the page.
#pragma once
#include <string>
#include <vector>

#include "model/limits.h"
#include "pipeline/fit_run.h"

namespace aspic {

// Limit of figures under a good verdict; others: model/limits.h.
inline constexpr double kSingle = 2;  // multiple of the limits of held-out errors for a single group. Chosen

// Errors of a held-out group beyond the noise of its readings, relative to the largest motion, force and torque of the
// data, or to 10 standard deviations if that is more; < 0: none.
struct PredictionErrors {
  std::string group;
  double position = -1, force = -1, torque = -1;

  bool is_poor(double factor) const;        // exceeds a multiple of the limits
  const struct ReadingKind& worst() const;  // with the largest multiple of its limit
};

// Kinds of held-out readings.
struct ReadingKind {
  const char *name, *peak;
  ReadingErrors HeldOut::*errors;
  double PredictionErrors::*beyond_noise;
  double limit;  // under a good verdict
};
inline constexpr ReadingKind kReadingKinds[] = {
    {"position", "motion", &HeldOut::positions, &PredictionErrors::position, 0.05},
    {"force", "force", &HeldOut::forces, &PredictionErrors::force, 0.1},
    {"torque", "torque", &HeldOut::torques, &PredictionErrors::torque, 0.1}};

// Readings of a fitted group with the largest error, root mean square in standard deviations.
struct GroupError {
  std::string group, readings;  // "poke 2", "forces"
  double sigmas = 0;
};
std::vector<GroupError> group_errors(const DataSet& data, const FitOutcome& outcome);

// Groups that were predicted from others, by cross-validation or because the fit leaves them out.
std::vector<HeldOut> predicted_groups(const DataSet& data, const FitOutcome& outcome);
HeldOut largest_readings(const DataSet& data);  // the peaks of all groups
std::vector<PredictionErrors> beyond_noise(const DataSet& data,
                                           const std::vector<HeldOut>& groups);  // of predicted ones
PredictionErrors all_groups(const std::vector<PredictionErrors>& groups);        // root mean square
// The errors of all predicted groups, which the verdict, the summary and the report judge.
PredictionErrors held_out_errors(const DataSet& data, const FitOutcome& outcome);

struct FitVerdict {
  std::vector<FitReason> reasons;  // reasons against the material; empty: the verdict is good
  std::string text;                // a sentence

  bool is_good() const { return reasons.empty(); }
};

// Error of the stiffness that linear tets may leave, although the mesh is corrected: its largest correction.
struct LinearTetError {
  double of_stiffness = -1;  // relative; < 0: unknown
};
// Empty if quadratic tets were simulated, the settings choose the order, or the material is for this mesh alone.
std::optional<LinearTetError> linear_tet_error(const DataSet& data, const FitOutcome& outcome);

// Names of the reasons: interrupted, not_converged, mesh_not_settled, mesh_too_coarse, linear_tets, at_bound,
// group_missed, held_out_worse, groups_disagree, unexplained, predicts_badly, field_rejected, relaxation_failed,
// relaxation_undetermined, relaxation_unexplained, no_good_law, fibres_undetermined.
FitVerdict verdict(const DataSet& data, const FitOutcome& outcome);

// Reasons why one value is better than a field: mesh_not_settled, at_bound, group_missed, held_out_worse.
std::vector<FitReason> reasons_against_field(const DataSet& data, const FitOutcome& outcome);

}  // namespace aspic
