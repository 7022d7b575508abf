// From a data set to a material with its uncertainty: all that `aspic fit` does, without a terminal.
#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "capture/data_set.h"
#include "capture/fit_plan.h"
#include "capture/journal.h"
#include "fit/cross_validation.h"
#include "fit/next_poke.h"
#include "fit/uncertainty.h"
#include "scene/material_file.h"

namespace aspic {

// A number for people.
struct ValueRow {
  std::string where;                 // "everywhere", "region 3", "softest tet", "median tet"
  double value = 0;                  // [SI]
  std::optional<Interval> interval;  // of 95 %; none: not known
};

// A fitted quantity over the body.
struct FittedQuantity {
  std::string name, unit;
  Spread spread = Spread::uniform;
  std::vector<double> values;                // one per tet, in the order of the data set [SI]
  std::vector<double> deviation, reduction;  // of each value in the fitted scale (log E); empty: unknown
  std::vector<ValueRow> rows;
};

// What is predicted for one case of the data.
struct CaseOutcome {
  bool left_out = false;  // of the fit
  bool ok = false;        // there is a prediction
  std::vector<Vec3d> markers;
  Wrench wrench;
  bool has_held_out = false;  // predicted by a fit without its group
  std::vector<Vec3d> held_out_markers;
  Wrench held_out_wrench;
  // Standard deviations with those of the correction for the mesh, as the fit used them [m], [N].
  std::vector<Vec3d> marker_deviation;
  Vec3d force_deviation{}, torque_deviation{};
  double relative_mesh_error = 0;  // of the force: |limit - mesh| over the smaller of both
};

// What a field of stiffness was divided into.
struct FoundParts {
  int tried = 0;               // numbers of parts
  bool are_kept = false;       // false: none explains the data as well as the field
  std::vector<double> values;  // [SI], ascending
  std::vector<double> volume;  // of each, as a share of the body
  double squares = 0;          // |r|^2 of what was kept, or of the last that was tried
};

// Why a material is not to be relied on.
struct FitReason {
  std::string name, text;  // "group_missed", "the forces of 'poke 2' are missed by 12 standard deviations"
};

struct FitOutcome {
  FitPlan plan;                      // completed
  FitReport report;                  // of the last stage that was begun
  std::optional<FitReport> uniform;  // of the first, where there are two: one value per quantity
  std::vector<FittedQuantity> quantities;
  FittedMaterial material;               // by the user's numbers
  std::vector<CaseOutcome> cases;        // one per case of the data
  std::vector<FitReason> against_field;  // why one value replaces the field that was wanted; empty: it does not
  bool mesh_errors_settle = true;        // false: they changed the material to the last
  std::vector<std::string> at_bound;     // quantities: "young in 3 tets"
  double mesh_error = -1;                // of the positions, root mean square over the largest motion; < 0: not known
  std::optional<Posterior> posterior;
  std::optional<FoundParts> parts;
  std::optional<CrossValidation> held_out;
  std::optional<CrossValidation> held_out_of_one_value;  // where a field is fitted
  std::optional<PokeCandidate> next_poke;
  std::vector<std::string> warnings;
  std::string failure;       // why there is no material; empty: there is one
  bool interrupted = false;  // the material is what was reached until then
  int unknowns = 0, residuals = 0;
  int simulated_tets = 0;  // those of the data, or more (FitPlan::refine)
  Misfit::Counts counts;

  bool has_material() const { return failure.empty(); }
};

enum class FitStage { uniform, mesh_errors, field, uncertainty, parts, cross_validation, next_poke };

struct FitCallbacks {
  std::function<void(FitStage, const std::string& what)> begin = {};  // called at the start of a stage or a part of it
  std::function<void(FitStage, const FitIteration&, std::span<const double> p)> iterate = {};
  StopToken stop = {};  // the outcome is then what was reached, and is marked as interrupted
};

// Where the fit is remembered; without a folder it is not.
struct FitMemory {
  std::filesystem::path folder;
  JournalStart start = JournalStart::anew;
};

// Throws InvalidInput for data and plans that do not fit together; a fit that fails is an outcome.
FitOutcome fit_material(const DataSet& data, const FitPlan& plan, const FitMemory& memory,
                        const FitCallbacks& callbacks);

}  // namespace aspic
