// Symmetric sparse matrices of 3x3 blocks. The pattern is symbolic and shared; the values change.
// Only the lower triangle is stored: block (r, c) with c <= r stands for block (c, r) as its transpose.
#pragma once
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "math/small.h"

namespace aspic {

using Couplings = std::vector<std::pair<int, int>>;  // vertex pairs that share a block; either order, repeats allowed

struct BlockPattern {
  std::vector<int64_t> row_start;  // rows + 1 entries
  std::vector<int> column;         // columns c <= r of each row, ascending; the last one is the diagonal
  // The transposed pattern: for each row r, the rows below it that have a block in column r, and the slots of these.
  std::vector<int64_t> upper_start;
  std::vector<int> upper_row;
  std::vector<int64_t> upper_slot;
  uint64_t version = 0;  // differs between any two patterns made in this process

  // Geometry and stiffness for the coarse spaces of multigrid; empty if unknown.
  std::vector<Vec3d> rest_position;  // of each row's vertex [m]
  std::vector<double> rest_modulus;  // of the material around each row's vertex, up to a common factor [Pa]

  int rows() const { return static_cast<int>(row_start.size()) - 1; }
  int64_t block_count() const { return static_cast<int64_t>(column.size()); }
  int64_t diagonal(int row) const { return row_start[row + 1] - 1; }
  int64_t slot(int row, int col) const;  // index of block (row, col), col <= row; it must exist
};

BlockPattern make_pattern(int rows, Couplings couplings);  // every diagonal block is included

struct BlockSparse {
  const BlockPattern* pattern = nullptr;
  std::vector<Mat3d> block;  // one per entry of pattern->column

  explicit BlockSparse(const BlockPattern& p) : pattern(&p), block(p.block_count()) {}
  void set_zero();
  void multiply(std::span<const double> x, std::span<double> y) const;  // y = H x; 3 numbers per row
};

}  // namespace aspic
