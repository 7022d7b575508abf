#pragma once
#include <cstdint>

#include "dynamics/state.h"
#include "mesh/numbering.h"

namespace aspic {

// 64 bits that two machines can compare. Over the bits w of all positions and then all velocities, as IEEE 754 doubles
// in the user's order of vertices:
//   hash = (hash xor w) * 0x100000001b3 mod 2^64, then hash = hash xor (hash >> 32), from hash = 0xcbf29ce484222325.
// Every w acts by a bijection, so that states that differ in one number never share a hash.
std::uint64_t state_hash(const State& state, const Renumbering& vertices);

}  // namespace aspic
