#pragma once
#include <cstdint>

#include "dynamics/state.h"
#include "mesh/numbering.h"

namespace aspic {

// A 64-bit hash of a state, equal on all machines. For the bits w of all positions and then all velocities, as IEEE 754
// doubles in the user's vertex order:
//   hash = (hash xor w) * 0x100000001b3 mod 2^64, then hash = hash xor (hash >> 32), from hash = 0xcbf29ce484222325.
// Each step is a bijection, so states that differ in one value have different hashes.
std::uint64_t state_hash(const State& state, const Renumbering& vertices);

}  // namespace aspic
