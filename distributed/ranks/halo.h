// Copies of the values of vertices that belong to other ranks.
#pragma once
#include <span>
#include <vector>

#include "ranks/mesh_share.h"
#include "ranks/traffic.h"

namespace aspic::distributed {

class Halo {
 public:
  explicit Halo(const MeshShare& share);  // collective

  // Replaces the entries of the ghosts by those of their ranks, 3 per vertex. Collective.
  void update(std::span<double> x);

  TrafficCounts& traffic() { return traffic_; }

 private:
  struct Neighbor {
    int rank;
    std::vector<int> sent;         // local numbers of own vertices that are ghosts of this rank
    int first_ghost, ghost_count;  // local numbers of the ghosts that belong to this rank
  };

  std::vector<Neighbor> neighbors_;
  std::vector<double> buffer_;  // values to send, neighbor by neighbor
  TrafficCounts traffic_;
};

}  // namespace aspic::distributed
