#include "dynamics/state.h"

#include <bit>

#include "base/compat.h"
#include "base/hash.h"
#include "mesh/vertices.h"

namespace aspic {

std::uint64_t continued_hash(std::uint64_t hash, std::span<const double> values) {
  for (const double value : values) {
    hash = (hash ^ bit_cast<std::uint64_t>(value)) * Fnv1a::kPrime;
    hash ^= hash >> 32;
  }
  return hash;
}

std::uint64_t state_hash(const State& state, const Renumbering& vertices) {
  std::uint64_t hash = Fnv1a::kBasis;
  for (const std::vector<double>* values : {&state.q, &state.qdot}) {
    const int count = static_cast<int>(values->size() / 3);
    for (int user = 0; user < count; ++user)
      hash = continued_hash(hash, std::span(*values).subspan(3 * static_cast<size_t>(vertices.from_user(user)), 3));
  }
  return hash;
}

State at_rest(const TetMesh& mesh) {
  State state;
  state.q = rest_positions(mesh);
  state.qdot.assign(state.q.size(), 0.0);
  return state;
}

}  // namespace aspic
