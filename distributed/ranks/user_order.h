// Values of vertices in the user's order, in which files have them: each rank has a slice.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "ranks/mesh_share.h"

namespace aspic::distributed {

class UserOrder {
 public:
  explicit UserOrder(const MeshShare& share);  // collective

  // First vertex of the slice of this rank, and their number.
  int first() const { return first_; }
  int count() const { return static_cast<int>(slice_.size()); }
  int all() const { return all_; }
  // Return values of the slice for those of the own vertices, and the reverse; 3 per vertex. Collective.
  std::vector<double> to_user(std::span<const double> own) const;
  std::vector<double> from_user(std::span<const double> slice) const;

 private:
  int first_, all_;
  std::vector<int> sent_;                        // own vertices, grouped by the rank of their slice
  std::vector<int> slice_;                       // vertices of the slice (from 0), grouped by the rank of their owner
  std::vector<int> sent_counts_, slice_counts_;  // of vertices for each rank
};

// Returns the hash of a state, see state_hash(), on all ranks, from the slices of its positions and velocities.
// Collective.
std::uint64_t hash_of_slices(std::span<const double> q, std::span<const double> qdot);

}  // namespace aspic::distributed
