// The cost of contact. Unlike all else, it may differ from run to run: earlier candidates save distances, and a resumed
// run has none.
#pragma once
#include <cstdint>

namespace aspic {

struct ContactCost {
  double search = 0;           // of stencils: wall time [s]
  double bound = 0;            // of steps and of impacts along directions: wall time [s]
  double forces = 0;           // energies, forces and Hessians of contact and friction: wall time [s]
  std::int64_t distances = 0;  // computed, without those that the search for candidates computes

  ContactCost since(const ContactCost& before) const {
    return {search - before.search, bound - before.bound, forces - before.forces, distances - before.distances};
  }
};

}  // namespace aspic
