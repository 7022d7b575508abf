// A preconditioner for H = A + S, where A is a BlockSparse matrix for which a preconditioner is known and S are its
// stencils: exact solves on the rows of the stencils before and after the preconditioner of A. It is symmetric, and
// its iteration counts hardly depend on how much stiffer than A the stencils are. Compare [arXiv 2505.18576].
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "linalg/approximate_inverse.h"
#include "linalg/cholesky.h"

namespace aspic {

class RowCorrection {
 public:
  // Factorizes the rows and columns of H that its stencils touch. Returns false if they are not positive definite.
  // H must outlive the applications.
  bool factorize(const BlockSparse& H);
  void drop() { rows_.clear(); }                     // apply() uses the preconditioner alone
  bool is_needed() const { return !rows_.empty(); }  // false: no stencils

  // z = M^-1 r, where M is the preconditioner of A with both corrections. 3 numbers per row.
  void apply(ApproximateInverse& preconditioner, std::span<const double> r, std::span<double> z);

 private:
  void collect_rows(const BlockSparse& H);
  bool factorize_rows(const BlockSparse& H);
  void residual_on_rows(std::span<const double> r, std::span<const double> z);  // b_ = r - H z on the rows
  void solve_rows() { cholesky_.substitute(b_, x_); }

  const BlockSparse* H_ = nullptr;
  std::vector<int> rows_;   // rows of the stencils, ascending
  std::vector<int> place_;  // of each row of H in rows_; -1: not there
  BlockPattern pattern_;
  std::optional<BlockSparse> A_;  // of rows_
  Cholesky cholesky_;
  std::vector<double> b_, x_;  // on rows_
  std::vector<double> r_, y_;  // on all rows
};

}  // namespace aspic
