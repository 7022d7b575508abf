#include "ranks/rank_multigrid.h"

#include <algorithm>

namespace aspic::distributed {
namespace {

// The pattern of the first rows, and of the same columns. Its blocks are the first ones of the whole pattern.
BlockPattern leading_part(const BlockPattern& whole, int rows) {
  Couplings couplings;
  for (int row = 0; row < rows; ++row)
    for (std::int64_t s = whole.row_start[row]; s < whole.diagonal(row); ++s)
      couplings.emplace_back(row, whole.column[s]);
  BlockPattern part = make_pattern(rows, std::move(couplings));
  part.rest_position.assign(whole.rest_position.begin(), whole.rest_position.begin() + rows);
  if (!whole.rest_modulus.empty())
    part.rest_modulus.assign(whole.rest_modulus.begin(), whole.rest_modulus.begin() + rows);
  return part;
}

}  // namespace

std::string RankMultigrid::description() const {
  return own_.description() + (has_coarse_space() ? " per rank, and affine displacements of all ranks" : "");
}

void RankMultigrid::analyze(const BlockPattern& pattern) {
  own_pattern_ = leading_part(pattern, mesh_.own());
  own_.analyze(own_pattern_);
  coarse_.analyze(pattern, own_pattern_);
  residual_.assign(3 * static_cast<size_t>(pattern.rows()), 0.0);
}

bool RankMultigrid::factorize(const BlockSparse& H) {
  bool is_definite = false;
  {
    BlockSparse own(own_pattern_);
    std::copy_n(H.block.begin(), own.block.size(), own.block.begin());
    is_definite = own_.factorize(own);
  }
  return share_.all(is_definite) && follow(H);
}

bool RankMultigrid::follow(const BlockSparse& H) {
  H_ = &H;
  return !has_coarse_space() || coarse_.factorize(H);
}

bool RankMultigrid::start(std::span<const double> b, std::span<double> x) {
  if (!has_coarse_space()) return false;
  std::fill(x.begin(), x.end(), 0.0);
  coarse_.add_correction(b, x);
  return true;
}

void RankMultigrid::apply(std::span<const double> r, std::span<double> z) {
  const size_t own = 3 * static_cast<size_t>(mesh_.own());
  own_.apply(r.first(own), z.first(own));
  if (!has_coarse_space()) return;
  halo_.update(z);
  H_->multiply(z, residual_);
  for (size_t i = 0; i < own; ++i) residual_[i] = r[i] - residual_[i];
  coarse_.add_correction(residual_, z);
}

}  // namespace aspic::distributed
