// Preconditioner for H = A + S, where A is a BlockSparse matrix with a known preconditioner and S are its stencils. It
// combines the preconditioner of A with exact solves on the rows of the stencils before and after it. It is symmetric,
// and its iteration counts depend little on the stiffness of S relative to A. Compare [arXiv 2505.18576].
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "linalg/approximate_inverse.h"
#include "linalg/cholesky.h"

namespace aspic {

class RowCorrection {
 public:
  // Factorizes the rows and columns of H with stencils; if that is expensive, only those of strong stencils. Returns
  // false if they are not positive definite. H must outlive the calls of apply().
  bool factorize(const BlockSparse& H);
  void drop() { rows_.clear(); }                     // apply() then uses the preconditioner alone
  bool is_needed() const { return !rows_.empty(); }  // false: no stencils

  // Computes z = M^-1 r, where M is the preconditioner of A with both corrections. r, z: 3 entries per row.
  void apply(ApproximateInverse& preconditioner, std::span<const double> r, std::span<double> z);

 private:
  template <class Test>
  void collect_rows(const BlockSparse& H, const Test& is_included);
  BlockPattern restricted_pattern(const BlockSparse& H) const;
  bool factorize_rows(const BlockSparse& H);
  template <class Visit>
  void visit_outside(int k, const Visit& visit) const;
  void solve_rows() { cholesky_.substitute(b_, x_); }

  const BlockSparse* H_ = nullptr;
  std::vector<int> rows_;   // rows of the included stencils, ascending
  std::vector<int> place_;  // place of each row of H in rows_; -1: absent
  BlockPattern pattern_;
  std::optional<BlockSparse> A_;  // rows and columns rows_ of H
  Cholesky cholesky_;
  std::vector<double> b_, x_;  // restricted to rows_
  std::vector<double> r_;      // all rows
};

}  // namespace aspic
