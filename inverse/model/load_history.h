// A load that varies in time slowly enough for inertia to be negligible, such as a ramp that is held, and the response
// of a body with Maxwell branches (energy/maxwell_branches.h) to it.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "model/misfit.h"

namespace aspic {

// Component of the force of an indenter or grip on the body.
struct ForceReading {
  double time = 0;              // [s]
  Vec3d axis{};                 // unit
  double value = 0, sigma = 0;  // [N], sigma > 0
};

// The body is at rest, without stress, before the first waypoint, whose load is applied suddenly. Between waypoints
// loads are linear in time; they change suddenly between two waypoints at the same time.
struct LoadHistory {
  std::string name;
  std::vector<double> times;         // ascending, one per waypoint [s]
  std::vector<LoadCase> waypoints;   // with the readings of markers; their forces are not used
  std::vector<ForceReading> forces;  // ascending in time, between the first waypoint and the last
};

// A Maxwell branch with the same ratio of its shear modulus to that of the material in all tets.
struct RelaxationBranch {
  double ratio = 0;  // > 0
  double time = 1;   // relaxation time [s]
};

struct ViscoelasticMaterial {
  std::string model;
  std::vector<MaterialParameters> parameters;  // long-term response, one per tet
  std::vector<RelaxationBranch> branches;
};

struct HistoryPrediction {
  std::string failure;         // empty: none
  std::vector<double> forces;  // one per reading of the history [N]
  std::vector<Vec3d> markers;  // of all waypoints, one after another [m]
  Wrench end;                  // of the indenter or grip, in the last state

  bool is_ok() const { return failure.empty(); }
};

// Sequence of equilibria in which time passes. Steps end at all readings; between these they resolve ramps and decays.
HistoryPrediction simulate(const Experiment& body, const LoadHistory& history, const ViscoelasticMaterial& material,
                           const EquilibriumOptions& options);

// The load between two waypoints: that of `a` for part = 0, of `b` for 1.
LoadCase load_between(const LoadCase& a, const LoadCase& b, double part);
bool is_same_load(const LoadCase& a, const LoadCase& b);

}  // namespace aspic
