#include "linalg/row_correction.h"

#include <algorithm>

#include "base/check.h"
#include "base/parallel.h"
#include "math/vectors.h"

namespace aspic {

void RowCorrection::collect_rows(const BlockSparse& H) {
  place_.assign(H.pattern->rows(), -1);
  for (const Stencil& stencil : H.stencils)
    for (const int row : stencil.row)
      if (row >= 0) place_[row] = 0;
  rows_.clear();
  for (int row = 0; row < H.pattern->rows(); ++row)
    if (place_[row] == 0) place_[row] = static_cast<int>(rows_.size()), rows_.push_back(row);
}

bool RowCorrection::factorize_rows(const BlockSparse& H) {
  const BlockPattern& p = *H.pattern;
  Couplings couplings;
  for (const int row : rows_)
    for (int64_t s = p.row_start[row]; s < p.diagonal(row); ++s)
      if (place_[p.column[s]] >= 0) couplings.emplace_back(place_[row], place_[p.column[s]]);
  for (const Stencil& stencil : H.stencils)
    for_each_block(stencil, [&](int i, int j, const Mat3d&) { couplings.emplace_back(place_[i], place_[j]); });
  A_.reset();
  pattern_ = make_pattern(static_cast<int>(rows_.size()), std::move(couplings));
  A_.emplace(pattern_);
  for (const int row : rows_)
    for (int64_t s = p.row_start[row]; s < p.row_start[row + 1]; ++s)
      if (const int column = place_[p.column[s]]; column >= 0)
        A_->block[pattern_.slot(place_[row], column)] = H.block[s];
  for (const Stencil& stencil : H.stencils)
    for_each_block(stencil, [&](int i, int j, const Mat3d& K) {  // place_ preserves the order of rows
      Mat3d& block = A_->block[pattern_.slot(place_[std::max(i, j)], place_[std::min(i, j)])];
      block = block + (i > j ? K : transpose(K));
    });
  cholesky_.analyze(pattern_);
  return cholesky_.factorize(*A_);
}

bool RowCorrection::factorize(const BlockSparse& H) {
  H_ = &H;
  rows_.clear();
  if (H.stencils.empty()) return true;
  collect_rows(H);
  for (auto* v : {&b_, &x_}) v->resize(3 * rows_.size());
  for (auto* v : {&r_, &y_}) v->resize(3 * static_cast<size_t>(H.pattern->rows()));
  return factorize_rows(H);
}

void RowCorrection::residual_on_rows(std::span<const double> r, std::span<const double> z) {
  const BlockPattern& p = *H_->pattern;
  parallel_chunks(static_cast<int>(rows_.size()), [&](int first, int last) {
    for (int k = first; k < last; ++k) {
      const int row = rows_[k];
      Vec3d sum = vec_at(r, row);
      for (int64_t s = p.row_start[row]; s < p.row_start[row + 1]; ++s)
        sum = sum - H_->block[s] * vec_at(z, p.column[s]);
      for (int64_t u = p.upper_start[row]; u < p.upper_start[row + 1]; ++u)
        sum = sum - transpose(H_->block[p.upper_slot[u]]) * vec_at(z, p.upper_row[u]);
      set_vec(sum, k, b_);
    }
  });
  for (const Stencil& stencil : H_->stencils)
    for_each_block(stencil, [&](int i, int j, const Mat3d& K) {
      add_vec(-1.0 * (K * vec_at(z, j)), place_[i], b_);
      add_vec(-1.0 * (transpose(K) * vec_at(z, i)), place_[j], b_);
    });
}

// The other numbers of y_ are zero.
void RowCorrection::subtract_product() {
  const BlockPattern& p = *H_->pattern;
  for (const int row : rows_) {
    const Vec3d y = vec_at(y_, row);
    for (int64_t s = p.row_start[row]; s < p.diagonal(row); ++s)
      add_vec(-1.0 * (transpose(H_->block[s]) * y), p.column[s], r_);
    add_vec(-1.0 * (H_->block[p.diagonal(row)] * y), row, r_);
    for (int64_t u = p.upper_start[row]; u < p.upper_start[row + 1]; ++u)
      add_vec(-1.0 * (H_->block[p.upper_slot[u]] * y), p.upper_row[u], r_);
  }
  for (const Stencil& stencil : H_->stencils)
    for_each_block(stencil, [&](int i, int j, const Mat3d& K) {
      add_vec(-1.0 * (K * vec_at(y_, j)), i, r_);
      add_vec(-1.0 * (transpose(K) * vec_at(y_, i)), j, r_);
    });
}

void RowCorrection::apply(ApproximateInverse& preconditioner, std::span<const double> r, std::span<double> z) {
  if (!is_needed()) return preconditioner.apply(r, z);
  for (size_t k = 0; k < rows_.size(); ++k) set_vec(vec_at(r, rows_[k]), static_cast<int>(k), b_);
  solve_rows();
  std::fill(y_.begin(), y_.end(), 0.0);
  for (size_t k = 0; k < rows_.size(); ++k) set_vec(vec_at(x_, static_cast<int>(k)), rows_[k], y_);
  std::copy(r.begin(), r.end(), r_.begin());
  subtract_product();
  preconditioner.apply(r_, z);
  for (size_t i = 0; i < y_.size(); ++i) z[i] += y_[i];
  residual_on_rows(r, z);
  solve_rows();
  for (size_t k = 0; k < rows_.size(); ++k) add_vec(vec_at(x_, static_cast<int>(k)), rows_[k], z);
}

}  // namespace aspic
