#include "mesh/order.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace aspic {
namespace {

constexpr int kBits = 21;  // per axis: three of them fit a 64-bit code

bool is_finite(const Vec3d& x) { return std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2]); }

// Two zeros in front of each of the lowest 21 bits.
uint64_t spread(uint64_t bits) {
  bits = (bits | bits << 32) & 0x001f00000000ffff;
  bits = (bits | bits << 16) & 0x001f0000ff0000ff;
  bits = (bits | bits << 8) & 0x100f00f00f00f00f;
  bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
  return (bits | bits << 2) & 0x1249249249249249;
}

struct Cube {
  Vec3d lower;
  double size;
};

Cube bounding_cube(std::span<const Vec3d> points) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Vec3d lower = {{kInfinity, kInfinity, kInfinity}}, upper = {{-kInfinity, -kInfinity, -kInfinity}};
  for (const Vec3d& x : points) {
    if (!is_finite(x)) continue;
    for (int axis = 0; axis < 3; ++axis) {
      lower[axis] = std::min(lower[axis], x[axis]);
      upper[axis] = std::max(upper[axis], x[axis]);
    }
  }
  return {lower, std::max({upper[0] - lower[0], upper[1] - lower[1], upper[2] - lower[2]})};
}

uint64_t morton_code(const Vec3d& x, const Cube& cube) {
  if (!is_finite(x) || !(cube.size > 0) || !std::isfinite(cube.size)) return 0;
  constexpr double kCells = 1 << kBits;
  uint64_t code = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double cell = (x[axis] - cube.lower[axis]) / cube.size * kCells;
    code |= spread(static_cast<uint64_t>(std::min(cell, kCells - 1))) << axis;
  }
  return code;
}

}  // namespace

std::vector<int> morton_order(std::span<const Vec3d> points) {
  const Cube cube = bounding_cube(points);
  std::vector<std::pair<uint64_t, int>> codes(points.size());
  for (size_t i = 0; i < points.size(); ++i) codes[i] = {morton_code(points[i], cube), static_cast<int>(i)};
  std::sort(codes.begin(), codes.end());
  std::vector<int> order(points.size());
  for (size_t i = 0; i < points.size(); ++i) order[i] = codes[i].second;
  return order;
}

std::vector<Vec3d> centroids(const TetMesh& mesh) {
  std::vector<Vec3d> centres;
  centres.reserve(mesh.tets.size());
  for (const auto& [a, b, c, d] : mesh.tets)
    centres.push_back(0.25 * ((mesh.rest[a] + mesh.rest[b]) + (mesh.rest[c] + mesh.rest[d])));
  return centres;
}

}  // namespace aspic
