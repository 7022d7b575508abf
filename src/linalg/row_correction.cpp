#include "linalg/row_correction.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/parallel.h"
#include "linalg/cholesky_cost.h"
#include "math/vectors.h"

namespace aspic {
namespace {

// While the factor of the rows with stencils would have more entries than H, those of weak stencils are left out, first
// those that couple two rows by less than kWeak times the smaller diagonal. For eight layers of cloth this halves the
// time per step, although iterations quadruple; without any correction it would be a tenth longer.
constexpr double kWeak = 0.3;

bool is_stronger(const Stencil& stencil, double ratio, const BlockSparse& H) {
  const auto diagonal = [&](int row) { return trace(H.block[H.pattern->diagonal(row)]); };
  bool is_any = false;
  for_each_block(stencil, [&](int i, int j, const Mat3d& K) {
    is_any = is_any || std::sqrt(squared_norm(K)) > ratio * std::min(diagonal(i), diagonal(j));
  });
  return is_any;
}

}  // namespace

template <class Test>
void RowCorrection::collect_rows(const BlockSparse& H, const Test& is_included) {
  place_.assign(H.pattern->rows(), -1);
  for (const Stencil& stencil : H.stencils)
    if (is_included(stencil))
      for (const int row : stencil.row)
        if (row >= 0) place_[row] = 0;
  rows_.clear();
  for (int row = 0; row < H.pattern->rows(); ++row)
    if (place_[row] == 0) place_[row] = static_cast<int>(rows_.size()), rows_.push_back(row);
}

// Returns the pattern of H restricted to rows_.
BlockPattern RowCorrection::restricted_pattern(const BlockSparse& H) const {
  const BlockPattern& p = *H.pattern;
  Couplings couplings;
  const auto add = [&](int i, int j) {
    if (place_[i] >= 0 && place_[j] >= 0) couplings.emplace_back(place_[i], place_[j]);
  };
  for (const int row : rows_)
    for (int64_t s = p.row_start[row]; s < p.diagonal(row); ++s) add(row, p.column[s]);
  for (const Stencil& stencil : H.stencils) for_each_block(stencil, [&](int i, int j, const Mat3d&) { add(i, j); });
  return make_pattern(static_cast<int>(rows_.size()), std::move(couplings));
}

bool RowCorrection::factorize_rows(const BlockSparse& H) {
  const BlockPattern& p = *H.pattern;
  A_.emplace(pattern_);
  for (const int row : rows_)
    for (int64_t s = p.row_start[row]; s < p.row_start[row + 1]; ++s)
      if (const int column = place_[p.column[s]]; column >= 0)
        A_->block[pattern_.slot(place_[row], column)] = H.block[s];
  for (const Stencil& stencil : H.stencils)
    for_each_block(stencil, [&](int i, int j, const Mat3d& K) {  // place_ preserves the order of rows
      if (place_[i] < 0 || place_[j] < 0) return;
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
  A_.reset();
  collect_rows(H, [](const Stencil&) { return true; });
  pattern_ = restricted_pattern(H);
  const double entries = 9.0 * static_cast<double>(H.pattern->block_count());
  for (double ratio = kWeak; ratio < 1 && predict_cholesky(pattern_).entries > entries; ratio += kWeak) {
    collect_rows(H, [&](const Stencil& stencil) { return is_stronger(stencil, ratio, H); });
    pattern_ = restricted_pattern(H);
  }
  for (auto* v : {&b_, &x_}) v->resize(3 * rows_.size());
  r_.resize(3 * static_cast<size_t>(H.pattern->rows()));
  return factorize_rows(H);
}

// Visits the blocks of H that couple the k-th of the rows with a row without stencils: visit(k, row, block).
template <class Visit>
void RowCorrection::visit_outside(int k, const Visit& visit) const {
  const BlockPattern& p = *H_->pattern;
  const int row = rows_[k];
  for (int64_t s = p.row_start[row]; s < p.diagonal(row); ++s)
    if (place_[p.column[s]] < 0) visit(p.column[s], H_->block[s]);
  for (int64_t u = p.upper_start[row]; u < p.upper_start[row + 1]; ++u)
    if (place_[p.upper_row[u]] < 0) visit(p.upper_row[u], transpose(H_->block[p.upper_slot[u]]));
}

// With the rows c of the stencils and the others o: solves H_cc y = r_c, lets the preconditioner compute p from r_o -
// H_oc y and zeros, and returns p_o and the solution of H_cc z_c = r_c - H_co p_o.
void RowCorrection::apply(ApproximateInverse& preconditioner, std::span<const double> r, std::span<double> z) {
  if (!is_needed()) return preconditioner.apply(r, z);
  const int count = static_cast<int>(rows_.size());
  for (int k = 0; k < count; ++k) set_vec(vec_at(r, rows_[k]), k, b_);
  solve_rows();
  std::copy(r.begin(), r.end(), r_.begin());
  for (int k = 0; k < count; ++k) {
    set_vec({}, rows_[k], r_);
    const Vec3d y = vec_at(x_, k);
    visit_outside(k, [&](int row, const Mat3d& K) { add_vec(-1.0 * (transpose(K) * y), row, r_); });
  }
  preconditioner.apply(r_, z);
  parallel_for(count, [&](int k) {
    Vec3d sum = vec_at(r, rows_[k]);
    visit_outside(k, [&](int row, const Mat3d& K) { sum = sum - K * vec_at(z, row); });
    set_vec(sum, k, b_);
  });
  solve_rows();
  for (int k = 0; k < count; ++k) set_vec(vec_at(x_, k), rows_[k], z);
}

}  // namespace aspic
