#include "mesh/order.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/parallel.h"

namespace aspic {
namespace {

constexpr int kBits = 21;  // per axis; three of them fit into 64 bits

bool is_finite(const Vec3d& x) { return std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2]); }

// Inserts two zeros before each of the lowest 21 bits.
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

using Cell = std::array<uint64_t, 3>;

// Returns the cell in the grid of the cube, or the corner cell if it is undefined.
Cell cell_of(const Vec3d& x, const Cube& cube) {
  if (!is_finite(x) || !(cube.size > 0) || !std::isfinite(cube.size)) return {};
  constexpr double kCells = 1 << kBits;
  Cell cell;
  for (int axis = 0; axis < 3; ++axis)
    cell[axis] = static_cast<uint64_t>(std::min((x[axis] - cube.lower[axis]) / cube.size * kCells, kCells - 1));
  return cell;
}

uint64_t morton_code(const Cell& cell) { return spread(cell[0]) | spread(cell[1]) << 1 | spread(cell[2]) << 2; }

// Returns the index along the Hilbert curve, by undoing the rotations of its parts from the largest to the smallest
// [Skilling2004].
uint64_t hilbert_code(Cell cell) {
  constexpr uint64_t kTop = uint64_t{1} << (kBits - 1);
  for (uint64_t bit = kTop; bit > 1; bit >>= 1)
    for (uint64_t& c : cell) {
      const uint64_t below = bit - 1,
                     is_set = 0 - static_cast<uint64_t>((c & bit) != 0);  // a mask: branches here cannot be predicted
      const uint64_t swapped = (cell[0] ^ c) & below & ~is_set;
      cell[0] ^= swapped | (below & is_set);
      c ^= swapped;
    }
  cell[1] ^= cell[0];
  cell[2] ^= cell[1];
  uint64_t turn = 0;
  for (uint64_t bit = kTop; bit > 1; bit >>= 1)
    if (cell[2] & bit) turn ^= bit - 1;
  return spread(cell[0] ^ turn) << 2 | spread(cell[1] ^ turn) << 1 | spread(cell[2] ^ turn);
}

template <class Code>
std::vector<int> order_by(const Code& code, std::span<const Vec3d> points) {
  const Cube cube = bounding_cube(points);
  std::vector<std::pair<uint64_t, int>> codes(points.size());
  parallel_chunks(static_cast<int>(points.size()), [&](int first, int last) {
    for (int i = first; i < last; ++i) codes[i] = {code(cell_of(points[i], cube)), i};
  });
  std::sort(codes.begin(), codes.end());
  std::vector<int> order(points.size());
  for (size_t i = 0; i < points.size(); ++i) order[i] = codes[i].second;
  return order;
}

}  // namespace

std::vector<int> morton_order(std::span<const Vec3d> points) { return order_by(morton_code, points); }
std::vector<int> hilbert_order(std::span<const Vec3d> points) { return order_by(hilbert_code, points); }

uint64_t hilbert_index(const Vec3d& point, const Vec3d& lower, double size) {
  return hilbert_code(cell_of(point, {lower, size}));
}

std::vector<Vec3d> centroids(const TetMesh& mesh) { return centroids(mesh, 0, mesh.tets.size()); }

std::vector<Vec3d> centroids(const TetMesh& mesh, int first, size_t count) {
  std::vector<Vec3d> centers;
  centers.reserve(count);
  for (const auto& [a, b, c, d] : std::span(mesh.tets).subspan(static_cast<size_t>(first), count))
    centers.push_back(0.25 * ((mesh.rest[a] + mesh.rest[b]) + (mesh.rest[c] + mesh.rest[d])));
  return centers;
}

}  // namespace aspic
