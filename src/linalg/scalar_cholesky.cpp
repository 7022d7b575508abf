#include "linalg/scalar_cholesky.h"

#include <algorithm>

#include "base/check.h"

namespace aspic {
namespace {

struct Neighbors {
  std::vector<int> start, of;

  Neighbors(int rows, std::span<const MatrixPlace> places) : start(static_cast<size_t>(rows) + 1, 0) {
    for (const auto& [i, j] : places)
      if (i != j) ++start[i + 1], ++start[j + 1];
    for (int i = 0; i < rows; ++i) start[i + 1] += start[i];
    of.resize(start[rows]);
    std::vector<int> next(start.begin(), start.end() - 1);
    for (const auto& [i, j] : places)
      if (i != j) of[next[i]++] = j, of[next[j]++] = i;
  }
  std::span<const int> around(int i) const { return std::span(of).subspan(start[i], start[i + 1] - start[i]); }
};

}  // namespace

// Greedy: joins each free row with free neighbors, or neighbors of neighbors. The remaining rows fill up blocks at the
// end.
void ScalarCholesky::group_rows(std::span<const MatrixPlace> places) {
  const int rows = static_cast<int>(slot_.size());
  const Neighbors graph(rows, places);
  std::fill(slot_.begin(), slot_.end(), -1);
  int blocks = 0;
  std::vector<std::vector<int>> parts;  // groups of fewer than three rows
  for (int i = 0; i < rows; ++i) {
    if (slot_[i] >= 0) continue;
    std::vector<int> group{i};
    slot_[i] = 0;
    for (size_t k = 0; k < group.size(); ++k)
      for (int j : graph.around(group[k])) {
        if (group.size() == 3) break;
        if (slot_[j] < 0) slot_[j] = 0, group.push_back(j);
      }
    if (group.size() < 3) {
      parts.push_back(group);
      continue;
    }
    for (int k = 0; k < 3; ++k) slot_[group[k]] = 3 * blocks + k;
    ++blocks;
  }
  int next = 3 * blocks;
  for (const std::vector<int>& part : parts) {
    if (next % 3 + part.size() > 3) next += 3 - next % 3;
    for (int i : part) slot_[i] = next++;
  }
  b_.assign(static_cast<size_t>(3 * ((next + 2) / 3)), 0.0);
  x_ = b_;
}

void ScalarCholesky::analyze(int rows, std::span<const MatrixPlace> places) {
  slot_.assign(static_cast<size_t>(rows), -1);
  group_rows(places);
  Couplings couplings;
  for (const auto& [i, j] : places)
    if (slot_[i] / 3 != slot_[j] / 3) couplings.emplace_back(slot_[i] / 3, slot_[j] / 3);
  pattern_ = std::make_unique<BlockPattern>(make_pattern(static_cast<int>(b_.size() / 3), std::move(couplings)));
  A_ = std::make_unique<BlockSparse>(*pattern_);
  target_.clear();
  for (const auto& [i, j] : places) {
    const auto [low, high] = std::minmax(slot_[i], slot_[j]);
    target_.push_back(9 * static_cast<size_t>(pattern_->slot(high / 3, low / 3)) + high % 3 + 3 * (low % 3));
  }
  cholesky_ = std::make_unique<Cholesky>();
  cholesky_->analyze(*pattern_);
}

bool ScalarCholesky::factorize(std::span<const double> values) {
  ASPIC_CHECK(values.size() == target_.size());
  A_->set_zero();
  for (size_t k = 0; k < values.size(); ++k) A_->block[target_[k] / 9].a[target_[k] % 9] += values[k];
  std::vector<char> is_used(b_.size(), 0);
  for (int slot : slot_) is_used[slot] = 1;
  for (int r = 0; r < pattern_->rows(); ++r) {
    Mat3d& D = A_->block[pattern_->diagonal(r)];
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < i; ++j) D(j, i) = D(i, j);
      if (!is_used[3 * r + i]) D(i, i) = 1;
    }
  }
  return cholesky_->factorize(*A_);
}

void ScalarCholesky::solve(std::span<const double> b, std::span<double> x) {
  ASPIC_CHECK(b.size() == slot_.size() && x.size() == slot_.size());
  for (size_t i = 0; i < slot_.size(); ++i) b_[slot_[i]] = b[i];
  cholesky_->solve(b_, x_, 1e-12);
  for (size_t i = 0; i < slot_.size(); ++i) x[i] = x_[slot_[i]];
}

}  // namespace aspic
