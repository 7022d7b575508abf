// Solutions of a linear system whose matrix has dense rows besides the factorized one.
#pragma once
#include <span>
#include <vector>

#include "linalg/dense_rows.h"
#include "linalg/linear_solver.h"

namespace aspic {

// Solutions of (A + sum of weight g g') x = b from those of A x = b, one row after another [Sherman and Morrison 1950].
class RankOneUpdates {
 public:
  // Solves A z = g for each row by the solver, which has factorized A, up to the tolerance of LinearSolver::solve().
  // The rows must outlive the calls of apply(). Adds the counts of the solves to `work`. Returns false if a solve
  // failed.
  bool prepare(LinearSolver& solver, const DenseRows& rows, double tolerance, SolveReport& work);
  void apply(std::span<double> x) const;  // x: the solution of A x = b, replaced
  void drop() { rows_ = nullptr; }
  bool is_ready() const { return rows_; }

 private:
  void apply(size_t first_rows, std::span<double> x) const;

  const DenseRows* rows_ = nullptr;
  std::vector<std::vector<double>> z_;
  std::vector<double> factor_;  // weight / (1 + weight g . z)
};

}  // namespace aspic
