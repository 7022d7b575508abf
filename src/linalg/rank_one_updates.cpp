#include "linalg/rank_one_updates.h"

#include "math/vectors.h"

namespace aspic {

bool RankOneUpdates::prepare(LinearSolver& solver, const DenseRows& rows, double tolerance, SolveReport& work) {
  drop();
  z_.resize(rows.size());
  factor_.resize(rows.size());
  rows_ = &rows;
  for (size_t k = 0; k < rows.size(); ++k) {
    z_[k].assign(rows[k].g.size(), 0.0);
    if (dot(rows[k].g, rows[k].g) > 0) {  // else all of its vertices are pinned
      const SolveReport solved = solver.solve(rows[k].g, z_[k], tolerance);
      work.iterations += solved.iterations, work.products += solved.products, work.cycles += solved.cycles;
      if (!solved.ok) {
        drop();
        return false;
      }
    }
    apply(k, z_[k]);
    factor_[k] = rows[k].weight / (1 + rows[k].weight * dot(rows[k].g, z_[k]));
  }
  return true;
}

void RankOneUpdates::apply(std::span<double> x) const { apply(rows_->size(), x); }

void RankOneUpdates::apply(size_t first_rows, std::span<double> x) const {
  for (size_t k = 0; k < first_rows; ++k) {
    const double part = factor_[k] * dot((*rows_)[k].g, x);
    for (size_t i = 0; i < x.size(); ++i) x[i] -= part * z_[k][i];
  }
}

}  // namespace aspic
