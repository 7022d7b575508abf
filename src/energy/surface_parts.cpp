#include "energy/surface_parts.h"

#include <cstddef>

namespace aspic {

std::vector<Barycentric> part_centroids(int n) {
  std::vector<Barycentric> points;
  points.reserve(static_cast<size_t>(n) * n);
  const auto add = [&](double i, double j) { points.push_back({1 - (i + j) / n, i / n, j / n}); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j) {
      add(i + 1.0 / 3, j + 1.0 / 3);
      if (i + j + 2 <= n) add(i + 2.0 / 3, j + 2.0 / 3);
    }
  return points;
}

}  // namespace aspic
