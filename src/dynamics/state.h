// Positions and velocities of all vertices, and angles of shells and rods, at one time.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/numbering.h"

namespace aspic {

struct TetMesh;

struct State {
  // Positions [m] and velocities [m/s], 3 per row of the model: those of the vertices, then angles of edges or segments
  // times a length and their rates, see Model::angle_rows.
  std::vector<double> q, qdot;
  double time = 0;  // [s]
  // Internal variables of the damping terms, see InternalTerms; empty: none, or those at the start of a simulation.
  std::vector<double> internal = {};
};

// Returns the state of a body in its rest shape, with zero velocities at time 0.
State at_rest(const TetMesh& mesh);

// A 64-bit hash of positions and velocities, equal on all machines. For the bits w of all positions and then all
// velocities, as IEEE 754 doubles in the user's order of vertices, then of the rows of angles:
//   hash = (hash xor w) * 0x100000001b3 mod 2^64, then hash = hash xor (hash >> 32), from hash = 0xcbf29ce484222325.
// Each step is a bijection, so states that differ in one number have different hashes.
std::uint64_t state_hash(const State& state, const Renumbering& vertices);
// Continues a hash with the bits of more numbers.
std::uint64_t continued_hash(std::uint64_t hash, std::span<const double> values);

}  // namespace aspic
