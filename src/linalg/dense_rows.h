// Rank-one parts of a symmetric matrix that couple many rows: sum over rows of weight g g'. The sparse matrix A does
// not contain them.
#pragma once
#include <span>
#include <vector>

#include "linalg/linear_solver.h"

namespace aspic {

struct DenseRow {
  std::vector<double> g;  // 3 entries per block row of A
  double weight = 0;      // > 0
};
using DenseRows = std::vector<DenseRow>;

// y += sum over rows of weight g (g . x)
void add_product(const DenseRows& rows, std::span<const double> x, std::span<double> y);

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
