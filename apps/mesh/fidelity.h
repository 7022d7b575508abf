// Agreement of tets with the surface that they fill.
#pragma once
#include <string>

#include "mesh/tet_mesh.h"

namespace aspic {

struct Fidelity {
  double volume = 0, filled = 0;    // volume enclosed by the surface, and volume of the tets
  double distance = 0;              // largest distance from a sampled point of either surface to the other
  double missed = 0;                // fraction of the surface that is farther from the tets than `allowed`
  int parts = 1, filled_parts = 1;  // connected parts
};

// Searches distances up to a few times `allowed`.
Fidelity fidelity(const TriMesh& body, const TetMesh& tets, double allowed);

// Returns why the tets do not represent the body; empty if they do. `unit` is the length of 1.
std::string mismatch(const Fidelity& fidelity, double allowed, double unit);

}  // namespace aspic
