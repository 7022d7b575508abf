// Fits a material with its uncertainty to a data set: `aspic fit` without the terminal.
#pragma once
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "data/data_set.h"
#include "estimate/cross_validation.h"
#include "estimate/relaxation_fit.h"
#include "estimate/uncertainty.h"
#include "pipeline/fit_jobs.h"
#include "pipeline/fit_plan.h"
#include "pipeline/journal.h"
#include "pipeline/law_choice.h"
#include "scene/material_file.h"

namespace aspic {

// Value for display.
struct ValueRow {
  std::string where;                 // "everywhere", "region 3", "softest tet", "median tet"
  double value = 0;                  // [SI]
  std::optional<Interval> interval;  // 95 % interval; empty: unknown
};

// Fitted quantity over the body.
struct FittedQuantity {
  std::string name, unit;
  Parameterization parameterization = Parameterization::uniform;
  std::vector<double> values;  // one per tet, in the order of the data set [SI]
  // Standard deviation and reduction of each value on the fitted scale (log E); empty: unknown.
  std::vector<double> sigma, reduction;
  std::vector<ValueRow> rows;
};

// Prediction for one case of the data.
struct CaseOutcome {
  bool left_out = false;  // held out of the fit
  bool ok = false;        // a prediction exists
  std::vector<Vec3d> markers;
  Wrench wrench;
  // The same without the correction for the discretization error.
  std::vector<Vec3d> markers_on_mesh;
  Wrench wrench_on_mesh;
  bool has_held_out = false;  // predicted by a fit without its group
  std::vector<Vec3d> held_out_markers;
  Wrench held_out_wrench;
  // Standard deviations used by the fit, including those of the mesh correction [m], [N].
  std::vector<Vec3d> marker_sigma;
  Vec3d force_sigma{}, torque_sigma{};
  double relative_mesh_error = 0;  // relative error of the force: |limit - mesh| over the smaller of both
};

// Parts of a divided stiffness field.
struct FoundParts {
  int tried = 0;                     // tried numbers of parts
  bool are_kept = false;             // false: none fits the data as well as the field
  std::vector<double> values;        // [SI], ascending
  std::vector<Interval> intervals;   // 95 % intervals of the values; empty: unknown
  std::optional<Interval> contrast;  // 95 % interval of values.back() / values.front(); empty: unknown
  std::vector<double> volume;        // fraction of the body for each part
  double squares = 0;                // |r|^2 of the kept division, or of the last one tried
};

// Estimate of a systematic error, in SI units.
struct EstimatedError {
  std::string name, unit;  // "tare z", "N"; the unit of `stated`, if any
  double value = 0;
  double sigma = -1;  // posterior standard deviation; < 0: unknown
  double prior_sigma = 0;
  std::optional<double> stated = {};  // friction, layer stiffness [Pa/m] or rim [m]; its logarithm has this error

  // Coefficient at the given number of standard deviations from its estimate.
  double coefficient(double sigmas = 0) const { return *stated * std::exp(value + sigmas * std::max(sigma, 0.0)); }
  bool is_from_data() const { return sigma >= 0 && 2 * sigma * sigma < prior_sigma * prior_sigma; }
};

// Reading with a large error, which the robust loss weights less.
struct Outlier {
  std::string load_case, reading;  // reading: name of a marker, "force" or "torque"
  double weight = 1;
};

// Reason why a material is not reliable.
struct FitReason {
  std::string name, text;  // "group_missed", "the forces of 'poke 2' are missed by 12 standard deviations"
  // The figure that exceeds its limit; empty for reasons without a figure.
  std::optional<double> value = {}, limit = {};
};

// Estimated factor of a common error of the readings (CommonError), in standard deviations.
struct FoundCommonError {
  std::string cause;
  double sigmas = 0;
};

// Direction of the fibres of a region, as an axis: its sign is irrelevant.
struct FoundFibres {
  std::string where;  // "everywhere", "region 3"
  Vec3d direction;
  // Half the opening of the cone that contains the direction with 95 % [degrees]; 90: undetermined, < 0: unknown. It
  // includes `others`.
  double cone = -1;
  std::vector<Vec3d> others;  // directions of other minima that explain the data as well
};

struct FitOutcome {
  FitPlan plan;                      // completed
  FitReport report;                  // report of the last started stage
  std::optional<FitReport> uniform;  // first of two stages: one value per quantity
  std::vector<FittedQuantity> quantities;
  FittedMaterial material;               // in the user's numbering
  std::vector<CaseOutcome> cases;        // one per case of the data
  std::vector<FitReason> against_field;  // why one value replaces the requested field; empty: it does not
  bool mesh_errors_settle = true;        // false: they did not converge with the material
  std::vector<FoundFibres> fibres;       // empty: no directions are fitted
  std::vector<EstimatedError> errors;
  std::vector<FoundCommonError> common_errors;
  std::vector<Outlier> outliers;
  std::vector<std::string> at_bound;  // quantities: "young in 3 tets"
  bool has_mesh_errors = false;       // the data are corrected for the discretization error
  double mesh_error = -1;             // error of the positions: root mean square over the largest motion; < 0: unknown
  std::optional<Posterior> posterior;
  std::optional<FoundParts> parts;
  std::optional<CrossValidation> held_out;
  std::optional<CrossValidation> held_out_of_one_value;  // for a fitted field
  std::optional<LawChoice> law_choice;                   // for a plan with model = kAutoLaw
  std::optional<RelaxationFit> relaxation;               // for data with histories
  std::vector<std::string> warnings;
  std::string failure;       // why there is no material; empty if there is one
  bool interrupted = false;  // the material is the current estimate; also if results of jobs are missing
  int parameter_count = 0, residuals = 0;
  int simulated_tets = 0;  // equal to those of the data, or more (FitPlan::refine)
  Misfit::Counts counts;

  bool has_material() const { return failure.empty(); }
  const Posterior* known_posterior() const { return posterior && posterior->ok ? &*posterior : nullptr; }
};

enum class FitStage { uniform, mesh_errors, field, uncertainty, parts, cross_validation, law, relaxation };

struct FitCallbacks {
  std::function<void(FitStage, const std::string& what)> begin = {};  // called at the start of each stage and substage
  std::function<void(FitStage, const FitIteration&, std::span<const double> p)> iterate = {};
  StopToken stop = {};  // a stop returns the current estimate, marked as interrupted
};

// Storage of the fit for resumption; none without a folder.
struct FitMemory {
  std::filesystem::path folder;
  JournalStart start = JournalStart::anew;
  FitJobs* jobs = nullptr;  // null: all are computed, and none is stored
  std::string prefix = {};  // of the names of files, if one folder stores several fits
};

// Fits a material. Throws InvalidInput for incompatible data and plan; a failed fit is reported in the outcome.
FitOutcome fit_material(const DataSet& data, const FitPlan& plan, const FitMemory& memory,
                        const FitCallbacks& callbacks);

}  // namespace aspic
