#include "linalg/affine_coarsening.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/parallel.h"

namespace aspic {
namespace {

// A function is dropped if orthogonalization reduces its norm to this fraction.
constexpr double kDependent = 1e-7;
constexpr int kTasks = 16;

// Applies modified Gram-Schmidt twice to the rows of one aggregate: value = weight R. `coarse_value` receives the rows
// of R.
void orthonormalize(std::span<const int> rows, std::span<const FourValues> value, std::vector<FourValues>& weight,
                    FourValues* coarse_value) {
  for (const int i : rows) weight[i] = value[i];
  for (int m = 0; m < 4; ++m) coarse_value[m] = {};
  const auto dot = [&](int m, int n) {
    double sum = 0;
    for (const int i : rows) sum += weight[i][m] * weight[i][n];
    return sum;
  };
  for (int n = 0; n < 4; ++n) {
    const double before = std::sqrt(dot(n, n));
    for (int pass = 0; pass < 2; ++pass)
      for (int m = 0; m < n; ++m) {
        const double r = dot(m, n);
        for (const int i : rows) weight[i][n] -= r * weight[i][m];
        coarse_value[m][n] += r;
      }
    const double norm = std::sqrt(dot(n, n));
    const bool is_dependent = !(norm > kDependent * before);
    coarse_value[n][n] = is_dependent ? 0 : norm;
    for (const int i : rows) weight[i][n] = is_dependent ? 0 : weight[i][n] / norm;
  }
}

BlockPattern coarse_pattern(const Graph& graph) {
  Couplings couplings;
  for (int a = 0; a < graph.vertex_count(); ++a) {
    for (int m = 0; m < 4; ++m)
      for (int n = 0; n < m; ++n) couplings.emplace_back(4 * a + m, 4 * a + n);
    for (const int b : graph.around(a))
      if (b < a)
        for (int k = 0; k < 16; ++k) couplings.emplace_back(4 * a + k / 4, 4 * b + k % 4);
  }
  return make_pattern(4 * graph.vertex_count(), std::move(couplings));
}

}  // namespace

AffineCoarsening make_affine_coarsening(const Graph& graph, const Aggregates& aggregates, int rows_per_vertex,
                                        std::span<const FourValues> value) {
  const int rows = graph.vertex_count() * rows_per_vertex;
  ASPIC_CHECK(static_cast<int>(value.size()) == rows);
  AffineCoarsening c;
  c.aggregate.resize(rows);
  for (int i = 0; i < rows; ++i) c.aggregate[i] = aggregates.of_vertex[i / rows_per_vertex];
  c.row_start.push_back(0);
  for (int a = 0; a < aggregates.count(); ++a) {
    for (const int v : aggregates.members(a))
      for (int k = 0; k < rows_per_vertex; ++k) c.row.push_back(v * rows_per_vertex + k);
    c.row_start.push_back(static_cast<int>(c.row.size()));
  }
  c.weight.assign(rows, {});
  c.coarse_value.resize(4 * static_cast<size_t>(aggregates.count()));
  parallel_for(aggregates.count(),
               [&](int a) { orthonormalize(c.rows_of(a), value, c.weight, &c.coarse_value[4 * a]); });
  c.graph = quotient(graph, aggregates.of_vertex, aggregates.count());
  c.pattern = coarse_pattern(c.graph);
  return c;
}

// Computes the coarse rows of one aggregate: the sums over its fine rows i of w_im (sum over j of H_ij w_jn).
class MatrixRestriction::Task {
 public:
  Task(const AffineCoarsening& c, const BlockSparse& fine, BlockSparse& coarse, Scratch& scratch)
      : c_(c), fine_(fine), coarse_(coarse), place_(scratch.place), neighbors_(scratch.neighbors) {}

  void run(int a) {
    const BlockPattern& p = *fine_.pattern;
    begin(a);
    for (const int i : c_.rows_of(a)) {
      for (int64_t s = p.row_start[i]; s < p.row_start[i + 1]; ++s) add(p.column[s], fine_.block[s]);
      for (int64_t u = p.upper_start[i]; u < p.upper_start[i + 1]; ++u)
        add(p.upper_row[u], transpose(fine_.block[p.upper_slot[u]]));
      finish_row(c_.weight[i]);
    }
    for (const Neighbor& b : neighbors_) write(a, b);
    for (int m = 0; m < 4; ++m)
      if (c_.coarse_value[4 * a + m][m] == 0)  // the function is zero
        coarse_.block[c_.pattern.diagonal(4 * a + m)] = identity3<double>();
  }

 private:
  // Lists only aggregates b <= a, because the lower triangle of the coarse matrix is stored.
  void begin(int a) {
    neighbors_.clear();
    for (const int b : c_.graph.around(a))
      if (b < a) neighbors_.push_back({.block = {}, .row = {}, .aggregate = b});
    neighbors_.push_back({.block = {}, .row = {}, .aggregate = a});
    for (size_t k = 0; k < neighbors_.size(); ++k) place_[neighbors_[k].aggregate] = static_cast<int>(k);
  }

  void add(int j, const Mat3d& H) {
    const int b = c_.aggregate[j];
    if (b < 0 || place_[b] < 0) return;
    Neighbor& sum = neighbors_[place_[b]];
    sum.is_reached = true;
    const auto w = Quad<double>::load(c_.weight[j].data());
    for (int k = 0; k < 9; ++k) sum.row[k] += Quad<double>::all(H.a[k]) * w;
  }

  void finish_row(const FourValues& w) {
    for (Neighbor& sum : neighbors_) {
      if (!sum.is_reached) continue;
      for (int m = 0; m < 4; ++m)
        for (int k = 0; k < 9; ++k) sum.block[m][k] += Quad<double>::all(w[m]) * sum.row[k];
      std::fill_n(sum.row, 9, Quad<double>::zero());
      sum.is_reached = false;
    }
  }

  void write(int a, const Neighbor& from) {
    place_[from.aggregate] = -1;
    for (int m = 0; m < 4; ++m) {
      const int64_t first =
          from.aggregate == a ? c_.pattern.diagonal(4 * a + m) - m : c_.pattern.slot(4 * a + m, 4 * from.aggregate);
      for (int n = 0; n < (from.aggregate == a ? m + 1 : 4); ++n)
        for (int k = 0; k < 9; ++k) coarse_.block[first + n].a[k] = from.block[m][k][n];
    }
  }

  const AffineCoarsening& c_;
  const BlockSparse& fine_;
  BlockSparse& coarse_;
  std::vector<int>& place_;
  std::vector<Neighbor>& neighbors_;
};

void MatrixRestriction::reserve(const AffineCoarsening& c) {
  size_t most = 0;
  for (int a = 0; a < c.count(); ++a) most = std::max(most, c.graph.around(a).size());
  scratch_.resize(kTasks);
  for (Scratch& scratch : scratch_) {
    scratch.place.assign(c.count(), -1);
    scratch.neighbors.reserve(most + 1);
  }
}

void MatrixRestriction::run(const AffineCoarsening& c, const BlockSparse& fine, BlockSparse& coarse) {
  ASPIC_CHECK(scratch_.size() == kTasks);
  const int count = c.count(), per_task = (count + kTasks - 1) / kTasks;
  parallel_for(kTasks, [&](int t) {
    Task task(c, fine, coarse, scratch_[t]);
    for (int a = t * per_task; a < std::min(count, (t + 1) * per_task); ++a) task.run(a);
  });
}

}  // namespace aspic
