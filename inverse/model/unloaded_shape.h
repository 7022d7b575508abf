// The unloaded shape of a body that was scanned under gravity: rest positions X whose equilibrium x(X) under the
// gravity of the scan has the scanned vertices. X := X + (scan - x(X)) converges if the weight strains the body
// moderately. The unloaded body has straight edges: vertices that refinement added, and nodes in the middle of edges,
// are in the middle of unloaded edges, so a finer mesh is one of the same body. Under the gravity of the scan, edges
// are curved, so markers are at constant distances from their surface points.
#pragma once
#include <optional>
#include <span>
#include <string>

#include "model/misfit.h"

namespace aspic {

struct UnloadedShape {
  std::optional<Experiment> experiment;  // with the unloaded mesh; empty: not found
  std::string failure;
};

// Returns the experiment as it is if its mesh is unloaded. Fixed vertices are those of the scan.
UnloadedShape unloaded(const Experiment& scanned, const std::string& material,
                       std::span<const MaterialParameters> parameters, const EquilibriumOptions& options);

}  // namespace aspic
