// Symmetric sparse matrices of 3x3 blocks. The pattern is symbolic and shared; the values change. Only the lower
// triangle is stored: block (r, c) with c <= r also represents block (c, r), its transpose.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "base/huge_pages.h"
#include "math/small.h"

namespace aspic {

using Couplings = std::vector<std::pair<int, int>>;  // vertex pairs that share a block; either order, repeats allowed

struct BlockPattern {
  std::vector<int64_t> row_start;  // rows + 1 entries
  LargeVector<int> column;         // columns c <= r of each row, ascending; the last one is the diagonal
  // The transposed pattern: for each row r, the rows below it with a block in column r, and the slots of these blocks.
  std::vector<int64_t> upper_start;
  LargeVector<int> upper_row;
  LargeVector<int64_t> upper_slot;
  uint64_t version = 0;  // unique among all patterns of this process

  // Geometry and stiffness for the coarse spaces of multigrid; empty if unknown.
  std::vector<Vec3d> rest_position;  // rest position of each row's vertex [m]
  std::vector<double> rest_modulus;  // modulus of the material at each row's vertex [Pa], up to a common factor
  int angle_rows = 0;                // last rows, whose entries are angles at rest_position instead of displacements

  int rows() const { return static_cast<int>(row_start.size()) - 1; }
  int64_t block_count() const { return static_cast<int64_t>(column.size()); }
  int64_t diagonal(int row) const { return row_start[row + 1] - 1; }  // index of block (row, row)
  int64_t slot(int row, int col) const;  // returns the index of block (row, col), col <= row; it must exist
};

// Returns the pattern of the given couplings and all diagonal blocks. Requires couplings of rows below `rows`.
BlockPattern make_pattern(int rows, Couplings couplings);

// A symmetric matrix that couples up to four block rows, such as two surfaces in contact. It stores the off-diagonal
// blocks; its diagonal blocks are added to those of the BlockSparse matrix.
struct Stencil {
  std::array<int, 4> row = {-1, -1, -1, -1};  // distinct rows; -1: unused
  std::array<Mat3d, 6> block = {};            // block (row[i], row[j]), j < i, is at index i (i - 1) / 2 + j
};

// Calls visit(i, j, K) for each block K = (i, j) of a stencil, i != j. Block (j, i) is K'.
template <class Visit>
void for_each_block(const Stencil& stencil, Visit visit) {
  for (int i = 1, k = 0; i < 4; ++i)
    for (int j = 0; j < i; ++j, ++k)
      if (stencil.row[i] >= 0 && stencil.row[j] >= 0) visit(stencil.row[i], stencil.row[j], stencil.block[k]);
}

// A matrix of the blocks of a pattern, which must outlive it, and of stencils.
struct BlockSparse {
  const BlockPattern* pattern = nullptr;
  LargeVector<Mat3d> block;       // one per entry of pattern->column
  std::vector<Stencil> stencils;  // added to the matrix; their pattern may change

  explicit BlockSparse(const BlockPattern& p) : pattern(&p), block(p.block_count()) { set_zero(); }
  void set_zero();                                                      // removes the stencils
  void multiply(std::span<const double> x, std::span<double> y) const;  // y = H x; x, y: 3 entries per row
};

}  // namespace aspic
