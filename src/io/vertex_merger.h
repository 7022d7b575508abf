// Merges vertices of formats that repeat them.
#pragma once
#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "base/compat.h"
#include "math/small.h"

namespace aspic {

struct PointHash {
  size_t operator()(const std::array<double, 3>& point) const {
    uint64_t hash = 0;
    for (const double x : point) hash = (hash ^ bit_cast<uint64_t>(x)) * 0x9e3779b97f4a7c15u, hash ^= hash >> 29;
    return hash;
  }
};

// Merges vertices at the same position. 0 and -0 are equal, because text files round small numbers to both.
class VertexMerger {
 public:
  int vertex(const Vec3d& point, std::vector<Vec3d>& vertices) {
    const std::array<double, 3> key = {point[0] + 0.0, point[1] + 0.0, point[2] + 0.0};
    const auto [entry, is_new] = index_.try_emplace(key, static_cast<int>(vertices.size()));
    if (is_new) vertices.push_back(point);
    return entry->second;
  }

 private:
  std::unordered_map<std::array<double, 3>, int, PointHash> index_;
};

}  // namespace aspic
