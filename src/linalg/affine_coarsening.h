// Coarse space of a multigrid method for elasticity. On each aggregate it consists of the affine displacements u(X) = A
// X + t of the rest shape, which include the rigid motions and their linearizations at any rotation. An aggregate has
// four coarse rows, one for each of four functions w_m that span (1, X, Y, Z) and are orthonormal over its rows:
//   u_row = sum over m of w_m(row) u_(4 a + m)
// Hence the coarse matrix also has 3x3 blocks, and the weights stay constant during the simulation.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "linalg/aggregation.h"
#include "linalg/block_sparse.h"
#include "math/lanes.h"

namespace aspic {

using FourValues = std::array<double, 4>;

struct AffineCoarsening {
  std::vector<int> aggregate;            // aggregate of each fine row; -1: none
  std::vector<int> row_start, row;       // fine rows of each aggregate, ascending
  std::vector<FourValues> weight;        // w_0 ... w_3 at each fine row
  std::vector<FourValues> coarse_value;  // (1, X, Y, Z) at each coarse row, for the next level
  Graph graph;                           // neighbors of each aggregate
  BlockPattern pattern;                  // coarse matrix, 4 rows per aggregate
  int count() const { return static_cast<int>(row_start.size()) - 1; }
  std::span<const int> rows_of(int a) const {
    return std::span(row).subspan(row_start[a], row_start[a + 1] - row_start[a]);
  }
};

// Computes the coarse functions of each aggregate. `value`: (1, X, Y, Z) at each fine row. Each vertex of `graph` has
// `rows_per_vertex` consecutive rows. On flat or small aggregates, functions that depend linearly on the others are set
// to zero.
AffineCoarsening make_affine_coarsening(const Graph& graph, const Aggregates& aggregates, int rows_per_vertex,
                                        std::span<const FourValues> value);

// Computes coarse = P' fine P. Rows of zero functions become rows of the identity.
class MatrixRestriction {
 public:
  void reserve(const AffineCoarsening& coarsening);
  void run(const AffineCoarsening& coarsening, const BlockSparse& fine, BlockSparse& coarse);

 private:
  // The coarse blocks that couple an aggregate with another one: entry k of block (m, n) is lane n of block[m][k].
  struct Neighbor {
    Quad<double> block[4][9];
    Quad<double> row[9];  // sum over j of H_ij w_jn for one fine row i
    int aggregate = 0;
    bool is_reached = false;
  };
  struct Scratch {
    std::vector<int> place;  // place of each aggregate in `neighbors`; -1: absent
    std::vector<Neighbor> neighbors;
  };
  class Task;
  std::vector<Scratch> scratch_;
};

}  // namespace aspic
