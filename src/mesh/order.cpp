#include "mesh/order.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

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

using Cell = std::array<uint32_t, 3>;

// Returns the cell in the grid of the cube, or the corner cell if it is undefined.
Cell cell_of(const Vec3d& x, const Cube& cube) {
  if (!is_finite(x) || !(cube.size > 0) || !std::isfinite(cube.size)) return {};
  constexpr double kCells = 1 << kBits;
  Cell cell;
  for (int axis = 0; axis < 3; ++axis)
    cell[axis] = static_cast<uint32_t>(std::min((x[axis] - cube.lower[axis]) / cube.size * kCells, kCells - 1));
  return cell;
}

uint64_t morton_code(const Cell& cell) { return spread(cell[0]) | spread(cell[1]) << 1 | spread(cell[2]) << 2; }

// Cells, coordinate by coordinate, so that one instruction serves several.
struct Cells {
  static constexpr int kMax = kChunkSize;
  std::array<std::array<uint32_t, kMax>, 3> at;
};

// Replaces the coordinates by the digits of the index along the Hilbert curve, by undoing the rotations of its parts
// from the largest to the smallest [Skilling2004].
void to_hilbert(Cells& cells) {
  constexpr uint32_t kTop = uint32_t{1} << (kBits - 1);
  auto& [x, y, z] = cells.at;
  for (uint32_t bit = kTop; bit > 1; bit >>= 1) {
    const uint32_t below = bit - 1;
    for (auto* axis : {&x, &y, &z})
      for (int i = 0; i < Cells::kMax; ++i) {
        uint32_t& c = (*axis)[i];
        const uint32_t is_set = 0 - static_cast<uint32_t>((c & bit) != 0);  // a mask: no branch, which would be a guess
        const uint32_t swapped = (x[i] ^ c) & below & ~is_set;
        x[i] ^= swapped | (below & is_set);
        c ^= swapped;
      }
  }
  for (int i = 0; i < Cells::kMax; ++i) {
    y[i] ^= x[i];
    z[i] ^= y[i];
    uint32_t turn = 0;
    for (uint32_t bit = kTop; bit > 1; bit >>= 1) turn ^= (z[i] & bit) != 0 ? bit - 1 : 0;
    x[i] ^= turn, y[i] ^= turn, z[i] ^= turn;
  }
}

// Calls put(i, index) for at most Cells::kMax points.
template <class Put>
void hilbert_codes(std::span<const Vec3d> points, const Cube& cube, const Put& put) {
  Cells cells{};
  for (size_t i = 0; i < points.size(); ++i) {
    const Cell cell = cell_of(points[i], cube);
    for (int axis = 0; axis < 3; ++axis) cells.at[axis][i] = cell[axis];
  }
  to_hilbert(cells);
  for (size_t i = 0; i < points.size(); ++i) put(i, morton_code({cells.at[2][i], cells.at[1][i], cells.at[0][i]}));
}

using Codes = std::vector<std::pair<uint64_t, int>>;

std::vector<int> order_by(Codes codes) {
  std::sort(codes.begin(), codes.end());
  std::vector<int> order(codes.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = codes[i].second;
  return order;
}

}  // namespace

std::vector<int> morton_order(std::span<const Vec3d> points) {
  const Cube cube = bounding_cube(points);
  Codes codes(points.size());
  parallel_chunks(static_cast<int>(points.size()), [&](int first, int last) {
    for (int i = first; i < last; ++i) codes[i] = {morton_code(cell_of(points[i], cube)), i};
  });
  return order_by(std::move(codes));
}

std::vector<int> hilbert_order(std::span<const Vec3d> points) {
  const Cube cube = bounding_cube(points);
  Codes codes(points.size());
  parallel_chunks(static_cast<int>(points.size()), [&](int first, int last) {
    hilbert_codes(points.subspan(first, last - first), cube, [&](size_t i, uint64_t code) {
      codes[first + i] = {code, first + static_cast<int>(i)};
    });
  });
  return order_by(std::move(codes));
}

uint64_t hilbert_index(const Vec3d& point, const Vec3d& lower, double size) {
  uint64_t index = 0;
  hilbert_codes({&point, 1}, {lower, size}, [&](size_t, uint64_t code) { index = code; });
  return index;
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
