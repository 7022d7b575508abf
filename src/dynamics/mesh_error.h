// An estimate of the discretization error of linear tets: by how much the mesh is stiffer than the body. The state is
// lifted to quadratic tets of the same material, in which the forces that act on the vertices are not in balance:
//   r = f - dV2/dy,   H2 d = r,   e = r.d / 2
// The correction d lowers the energy by e. f contains loads and inertia; those of surfaces are interpolated along them.
// Forces and Hessians of contact and other loads are held at the vertices. See docs/verification.md.
#pragma once
#include <string>
#include <vector>

#include "base/stop_token.h"
#include "dynamics/model.h"
#include "dynamics/pins.h"
#include "dynamics/state.h"
#include "dynamics/step_terms.h"

namespace aspic {

struct BodyMeshError {
  double energy = 0;  // e: energy above the minimum [J]
  // k: the stiffness of the mesh relative to that of the body, minus 1. Under one load, the body moves too little by
  // k / (1 + k); pins that move it need a force too large by k; frequencies are too high by sqrt(1 + k) - 1. NaN: the
  // body is not strained.
  double stiffness = 0;
  // Statics: largest correction of a vertex over the largest corrected displacement; NaN: in motion, or without pins.
  double motion = 0;
  int worst_tet = -1;  // the tet of the model with the largest density; -1: none
};

struct MeshErrorEstimate {
  std::string reason;        // why there is no estimate; empty: there is one
  bool is_reliable = false;  // false: quadratic tets are unstable in this state, as in buckling
  std::vector<BodyMeshError> bodies;
  std::vector<double> density;     // energy of the correction inside of each tet, over its volume [J/m^3]
  std::vector<double> correction;  // d at the vertices, 3 per vertex [m]
};

struct MeshErrorInput {
  const Model& model;
  const Pins& pins;
  const StepTerms& terms;       // of a step that ended at the state
  const BlockPattern& pattern;  // to which the terms are bound
  const State& state;
  bool is_static;
  double h;      // length of the step [s]
  double since;  // duration since the start [s]
};

MeshErrorEstimate estimate_mesh_error(const MeshErrorInput& input, const StopToken& stop = {});

// Returns the edge length, relative to the current one, with which the stiffness k is expected to become `target`.
double edge_factor(double stiffness, double target);

}  // namespace aspic
