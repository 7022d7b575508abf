// Triangles subdivided into n^2 equal parts, for sums over points of a surface.
#pragma once
#include <array>
#include <map>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

using Barycentric = std::array<double, 3>;

// Returns the centroids of the n^2 parts of a triangle whose edges are divided into n segments.
std::vector<Barycentric> part_centroids(int n);

// Caches the centroids for all requested n.
class PartCentroids {
 public:
  const std::vector<Barycentric>& of(int n) {
    const auto [entry, is_new] = lists_.try_emplace(n);
    if (is_new) entry->second = part_centroids(n);
    return entry->second;
  }

 private:
  std::map<int, std::vector<Barycentric>> lists_;  // map: its entries never move
};

}  // namespace aspic
