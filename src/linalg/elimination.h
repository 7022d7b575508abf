// The symbolic side of a sparse Cholesky factorization, on the graph of the blocks: which columns of L have the same
// rows and are factorized together (supernodes), and what that will cost.
#pragma once
#include <cstdint>
#include <vector>

#include "linalg/block_sparse.h"

namespace aspic {

struct CholeskyAnalysis {
  int64_t nnz = 0;    // entries of L that are stored, explicit zeros included
  int64_t bytes = 0;  // all that the numeric factorization allocates: L, update matrices, index lists
  double flops = 0;   // of one numeric factorization; a multiplication and an addition count as two
};

struct Supernodes {
  std::vector<int> order;            // order[k]: the row of the matrix that is eliminated k-th
  std::vector<int> position;         // its inverse
  std::vector<int> first;            // supernode s has the columns [first[s], first[s + 1])
  std::vector<int> parent;           // -1 for a root; children come before their parents
  std::vector<int64_t> row_start;    // row lists below the columns: count() + 1 entries
  std::vector<int> row;              // ascending within a supernode; empty until list_rows()
  std::vector<int> in_parent;        // place of this row in the parent's front
  std::vector<int> run_end;          // end of the entries from here that are neighbors in the parent's front, too
  std::vector<int64_t> value_start;  // first value of each supernode's dense panel: count() + 1 entries
  CholeskyAnalysis cost;

  int count() const { return static_cast<int>(first.size()) - 1; }
  int width(int s) const { return first[s + 1] - first[s]; }                            // columns [blocks]
  int below(int s) const { return static_cast<int>(row_start[s + 1] - row_start[s]); }  // rows below them [blocks]
};

double factor_flops(int64_t columns, int64_t below);  // of a dense panel and its update matrix

// Elimination tree, column counts, relaxed supernodes and their cost for this order of elimination (made postorder).
Supernodes find_supernodes(const BlockPattern& pattern, std::vector<int> order);

// The row lists take memory of their own, so they are made only when a factorization is wanted.
void list_rows(const BlockPattern& pattern, Supernodes& supernodes);

}  // namespace aspic
