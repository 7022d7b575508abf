// How well tets fill the surface that they were made from.
#pragma once
#include <string>

#include "mesh/tet_mesh.h"

namespace aspic {

struct Fidelity {
  double volume = 0, filled = 0;    // enclosed by the surface, and of the tets
  double distance = 0;              // largest from a sampled point of either surface to the other
  double missed = 0;                // part of the surface that is farther from the tets than `allowed`
  int parts = 1, filled_parts = 1;  // that hang together
};

// Distances are searched up to a few times `allowed`.
Fidelity fidelity(const TriMesh& body, const TetMesh& tets, double allowed);

// Why the tets are not the body; empty when they are. `unit` is the length of 1.
std::string mismatch(const Fidelity& fidelity, double allowed, double unit);

}  // namespace aspic
