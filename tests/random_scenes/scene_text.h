// Small random scenes: bodies, materials, loads, initial states, integrators and solver options.
#pragma once
#include <cstdint>
#include <string>

namespace aspic {

// Returns a TOML text, equal on all machines for the same seed.
std::string random_scene(uint64_t seed);

}  // namespace aspic
