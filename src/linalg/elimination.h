// Symbolic analysis of a sparse Cholesky factorization on the graph of the blocks: finds the columns of L with equal
// sparsity, which are factorized together (supernodes), and predicts the cost.
#pragma once
#include <cstdint>
#include <vector>

#include "linalg/block_sparse.h"

namespace aspic {

struct CholeskyAnalysis {
  int64_t nnz = 0;    // stored entries of L, explicit zeros included
  int64_t bytes = 0;  // memory that the numeric factorization allocates: L, update matrices, index lists
  double flops = 0;   // flops of one numeric factorization; a multiply-add counts as two
};

struct Supernodes {
  std::vector<int> order;          // order[k]: the row of the matrix that is eliminated k-th
  std::vector<int> position;       // its inverse
  std::vector<int> first;          // supernode s has the columns [first[s], first[s + 1])
  std::vector<int> parent;         // -1 for a root; children come before their parents
  std::vector<int64_t> row_start;  // row lists below the columns: count() + 1 entries
  std::vector<int> row;            // rows of each list, ascending; empty until list_rows()
  std::vector<int> in_parent;      // place of this row in the parent's front
  std::vector<int> run_end;  // end of the run of entries, from this one on, that are consecutive in the parent's front
  std::vector<int64_t> value_start;  // first value of each supernode's dense panel: count() + 1 entries
  CholeskyAnalysis cost;

  int count() const { return static_cast<int>(first.size()) - 1; }
  int width(int s) const { return first[s + 1] - first[s]; }                            // width in block columns
  int below(int s) const { return static_cast<int>(row_start[s + 1] - row_start[s]); }  // block rows below
};

double factor_flops(int64_t columns, int64_t below);  // flops of a dense panel and its update matrix

// Computes elimination tree, column counts, relaxed supernodes and costs for this elimination order (made a postorder).
Supernodes find_supernodes(const BlockPattern& pattern, std::vector<int> order);

// Computes the row lists. They need additional memory, so they are made only for an actual factorization.
void list_rows(const BlockPattern& pattern, Supernodes& supernodes);

}  // namespace aspic
