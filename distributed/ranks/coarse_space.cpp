#include "ranks/coarse_space.h"

#include <mpi.h>

#include <algorithm>

#include "math/vectors.h"
#include "ranks/exchange.h"
#include "ranks/message_size.h"

namespace aspic::distributed {
namespace {

constexpr int kFunctions = 4;  // (1, X, Y, Z), each with 3 directions

// Maximum number of vertices of a piece; pieces have half of it on average. More pieces save iterations, but the factor
// of their matrix is on every rank.
int piece_size(int vertices) { return std::max({48, std::min(120, vertices / 32), vertices / 256}); }

std::vector<char> isolated_rows(const BlockSparse& H, int rows) {
  const BlockPattern& p = *H.pattern;
  std::vector<char> isolated(rows, 1);
  for (int row = 0; row < rows; ++row) {
    for (std::int64_t s = p.row_start[row]; s < p.diagonal(row) && isolated[row]; ++s)
      isolated[row] = squared_norm(H.block[s]) == 0;
    for (std::int64_t u = p.upper_start[row]; u < p.upper_start[row + 1] && isolated[row]; ++u)
      isolated[row] = squared_norm(H.block[p.upper_slot[u]]) == 0;
  }
  return isolated;
}

// Couples all functions of each piece with each other and with those of its neighbors. `pairs`: two pieces each.
BlockPattern pattern_of_pieces(int pieces, std::span<const int> pairs) {
  Couplings couplings;
  const auto couple = [&](int a, int b) {
    for (int m = 0; m < kFunctions; ++m)
      for (int n = 0; n < kFunctions; ++n) couplings.emplace_back(kFunctions * a + m, kFunctions * b + n);
  };
  for (int a = 0; a < pieces; ++a) couple(a, a);
  for (size_t k = 0; k < pairs.size(); k += 2) couple(pairs[k], pairs[k + 1]);
  return make_pattern(kFunctions * pieces, std::move(couplings));
}

}  // namespace

void CoarseSpace::analyze(const BlockPattern& pattern, const BlockPattern& own) {
  pattern_ = &pattern, own_ = &own;
  is_built_ = false;
}

Aggregates CoarseSpace::pieces_of_own_vertices() const {
  const int size = piece_size(mesh_.cut.back());
  const Graph graph = graph_of(*own_);
  AggregationInput input{graph, own_->rest_position, own_->rest_modulus, isolated_, size};
  Aggregates pieces = make_aggregates(input);
  if (pieces.count() <= 1 + 4 * own_->rows() / size) return pieces;
  input.modulus = {};  // it jumps almost everywhere
  return make_aggregates(input);
}

// Numbers the pieces of all ranks and returns those of the local vertices.
Aggregates CoarseSpace::number_pieces(const std::vector<int>& piece_of_own) {
  const int rows = pattern_->rows();
  std::vector<double> number(3 * static_cast<size_t>(rows), -1);
  for (int v = 0; v < mesh_.own(); ++v)
    if (piece_of_own[v] >= 0) number[3 * static_cast<size_t>(v)] = first_ + piece_of_own[v];
  halo_.update(number);
  Aggregates local;
  for (int v = 0; v < rows; ++v) local.of_vertex.push_back(static_cast<int>(number[3 * static_cast<size_t>(v)]));
  number_ = local.of_vertex;
  std::sort(number_.begin(), number_.end());
  number_.erase(std::unique(number_.begin(), number_.end()), number_.end());
  if (!number_.empty() && number_[0] < 0) number_.erase(number_.begin());
  const auto place = [&](int n) {
    return static_cast<int>(std::lower_bound(number_.begin(), number_.end(), n) - number_.begin());
  };
  first_local_ = place(first_);
  std::vector<std::vector<int>> members(number_.size());
  for (int v = 0; v < rows; ++v) {
    int& piece = local.of_vertex[v];
    if (piece >= 0) members[piece = place(piece)].push_back(v);
  }
  local.start.push_back(0);
  for (const std::vector<int>& vertices : members) {
    local.member.insert(local.member.end(), vertices.begin(), vertices.end());
    local.start.push_back(static_cast<int>(local.member.size()));
  }
  return local;
}

// Their ranks know the whole piece.
void CoarseSpace::take_weights_of_ghosts() {
  std::vector<double> triple(3 * local_.weight.size());
  for (const auto& [first, last] : {std::pair{0, 3}, std::pair{3, kFunctions}}) {
    for (size_t v = 0; v < local_.weight.size(); ++v)
      for (int m = first; m < last; ++m) triple[3 * v + m - first] = local_.weight[v][m];
    halo_.update(triple);
    for (size_t v = 0; v < local_.weight.size(); ++v)
      for (int m = first; m < last; ++m) local_.weight[v][m] = triple[3 * v + m - first];
  }
}

void CoarseSpace::keep_own_rows() {
  std::vector<int> start{0}, row;
  for (int a = 0; a < local_.count(); ++a) {
    const std::span<const int> rows = local_.rows_of(a);
    if (a >= first_local_ && a < first_local_ + own_pieces_) row.insert(row.end(), rows.begin(), rows.end());
    start.push_back(static_cast<int>(row.size()));
  }
  local_.row_start = std::move(start);
  local_.row = std::move(row);
}

void CoarseSpace::gather_pattern() {
  std::vector<int> pairs;  // the coarse rows of a piece come from its rank
  for (int a = first_local_; a < first_local_ + own_pieces_; ++a)
    for (const int b : local_.graph.around(a))
      if (b < a) pairs.insert(pairs.end(), {number_[a], number_[b]});
  counts_.clear(), starts_.clear();
  int pieces = 0;
  for (const int count : gather_all(std::vector<int>{own_pieces_})) {
    counts_.push_back(3 * kFunctions * count), starts_.push_back(3 * kFunctions * pieces);
    pieces += count;
  }
  coarse_pattern_ = pattern_of_pieces(pieces, gather_all(pairs));
  coarse_matrix_ = std::make_unique<BlockSparse>(coarse_pattern_);
  cholesky_.analyze(coarse_pattern_);
  own_b_.assign(3 * kFunctions * static_cast<size_t>(own_pieces_), 0.0);
  x_.assign(3 * kFunctions * static_cast<size_t>(pieces), 0.0);
  b_ = x_;
}

void CoarseSpace::build() {
  const Aggregates pieces = pieces_of_own_vertices();
  own_pieces_ = pieces.count();
  first_ = static_cast<int>(sum_before(own_pieces_));
  const Aggregates local = number_pieces(pieces.of_vertex);
  std::vector<FourValues> value;
  for (const Vec3d& X : pattern_->rest_position) value.push_back({1, X[0], X[1], X[2]});
  local_ = make_affine_coarsening(graph_of(*pattern_), local, 1, value);
  take_weights_of_ghosts();
  keep_own_rows();
  restriction_.reserve(local_);
  local_matrix_ = std::make_unique<BlockSparse>(local_.pattern);
  gather_pattern();
}

bool CoarseSpace::factorize(const BlockSparse& H) {
  std::vector<char> isolated = isolated_rows(H, mesh_.own());
  if (!share_.all(is_built_ && isolated == isolated_)) {
    isolated_ = std::move(isolated);
    build();
    is_built_ = true;
  }
  if (b_.empty()) return true;
  restriction_.run(local_, H, *local_matrix_);
  // Own pieces have the same neighbors in the local and in the coarse pattern, in the same order.
  const std::vector<std::int64_t>& start = local_.pattern.row_start;
  const auto begin = local_matrix_->block.begin();
  const std::vector<Mat3d> blocks = gather_all(std::vector<Mat3d>(
      begin + start[kFunctions * first_local_], begin + start[kFunctions * (first_local_ + own_pieces_)]));
  coarse_matrix_->block.assign(blocks.begin(), blocks.end());
  return share_.all(cholesky_.factorize(*coarse_matrix_));
}

void CoarseSpace::add_correction(std::span<const double> r, std::span<double> z) {
  if (b_.empty()) return;
  for (int a = 0; a < own_pieces_; ++a) {
    Vec3d sum[kFunctions] = {};
    for (const int v : rows_of_own(a))
      for (int m = 0; m < kFunctions; ++m) sum[m] = sum[m] + local_.weight[v][m] * vec_at(r, v);
    for (int m = 0; m < kFunctions; ++m) set_vec(sum[m], kFunctions * a + m, own_b_);
  }
  MPI_Allgatherv(own_b_.data(), message_size(own_b_.size()), MPI_DOUBLE, b_.data(), counts_.data(), starts_.data(),
                 MPI_DOUBLE, MPI_COMM_WORLD);
  ++halo_.traffic().all.reductions;
  cholesky_.substitute(b_, x_);
  for (int a = 0; a < own_pieces_; ++a)
    for (const int v : rows_of_own(a))
      for (int m = 0; m < kFunctions; ++m)
        add_vec(local_.weight[v][m] * vec_at(x_, kFunctions * (first_ + a) + m), v, z);
}

}  // namespace aspic::distributed
