// Small scenes that nobody thought of: bodies, materials, loads, starts, schemes and solver options drawn at random.
#pragma once
#include <cstdint>
#include <string>

namespace aspic {

// A TOML file; the same seed gives the same text everywhere.
std::string random_scene(uint64_t seed);

}  // namespace aspic
