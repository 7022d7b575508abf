// Triangles cut into n^2 equal parts, for sums over points of a surface.
#pragma once
#include <array>
#include <map>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

using Barycentric = std::array<double, 3>;

// The centroids of the n^2 parts of a triangle whose edges are cut into n.
std::vector<Barycentric> part_centroids(int n);

// The lists for all n that were asked for, each made once.
class PartCentroids {
 public:
  const std::vector<Barycentric>& of(int n) {
    const auto [entry, is_new] = lists_.try_emplace(n);
    if (is_new) entry->second = part_centroids(n);
    return entry->second;
  }

 private:
  std::map<int, std::vector<Barycentric>> lists_;  // whose entries stay where they are
};

}  // namespace aspic
