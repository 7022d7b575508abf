// Figures of each case for reports: load and response with their units, predictions on the mesh and corrected for it,
// and residuals in standard deviations.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "pipeline/fit_run.h"

namespace aspic {

// "depth", "m"; "torque", "N m"
struct Measure {
  std::string name, unit;
};

// Response along the load: the force along the displacement, the torque about the axis of rotation, or the mean motion
// of the markers.
struct Response {
  std::optional<double> measured;
  double sigma = 0;
  std::optional<double> fitted, on_mesh;  // corrected for the discretization error, and as simulated
  std::optional<double> held_out;         // by a fit without the group
};

struct CaseFigures {
  Measure load, response;  // equal for all cases of a group
  double load_value = 0;
  Response values;
  int readings = 0;           // coordinates
  std::optional<double> rms;  // root mean square of the residuals [standard deviations]; empty: not fitted
};

// Unit of a response over a load: "N/m", "N m/rad"; empty if it is no stiffness.
std::string stiffness_unit(const CaseFigures& figures);

std::vector<CaseFigures> case_figures(const DataSet& data, const FitOutcome& outcome);  // one per case

// Calls use(residual) for every residual of a fitted case, in standard deviations.
void for_each_residual(const LoadCase& load, const CaseOutcome& outcome, const std::function<void(double)>& use);

// Number of readings of a marker that a page contains per case; see shown_readings().
inline constexpr size_t kMaxShownReadings = 5000;
// Indices of the readings of a case for pictures and tables: all, or the worst ones and evenly spread others.
std::vector<int> shown_readings(const LoadCase& load, const CaseOutcome& outcome);

}  // namespace aspic
