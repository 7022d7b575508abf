#include "linalg/affine_coarsening.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/parallel.h"

namespace aspic {
namespace {

// A function is dropped when orthogonalisation leaves less of it than this part.
constexpr double kDependent = 1e-7;
constexpr int kTasks = 16;

// Modified Gram-Schmidt, twice, on the rows of one aggregate: value = weight R; rows of R go to `coarse_value`.
void orthonormalise(std::span<const int> rows, std::span<const FourValues> value, std::vector<FourValues>& weight,
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

void add_scaled(double s, const Mat3d& A, Mat3d& B) {
  for (int k = 0; k < 9; ++k) B.a[k] += s * A.a[k];
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
               [&](int a) { orthonormalise(c.rows_of(a), value, c.weight, &c.coarse_value[4 * a]); });
  c.graph = quotient(graph, aggregates.of_vertex, aggregates.count());
  c.pattern = coarse_pattern(c.graph);
  return c;
}

// The coarse rows of one aggregate: sums over its fine rows i of w_im (sum over j of H_ij w_jn).
class MatrixRestriction::Task {
 public:
  Task(const AffineCoarsening& c, const BlockSparse& fine, BlockSparse& coarse, Scratch& scratch)
      : c_(c), fine_(fine), coarse_(coarse), place_(scratch.place), sums_(scratch.sums) {}

  void run(int a) {
    const BlockPattern& p = *fine_.pattern;
    clear(a);
    for (const int i : c_.rows_of(a)) {
      sums_.clear();
      for (int64_t s = p.row_start[i]; s < p.row_start[i + 1]; ++s) add(a, p.column[s], fine_.block[s]);
      for (int64_t u = p.upper_start[i]; u < p.upper_start[i + 1]; ++u)
        add(a, p.upper_row[u], transpose(fine_.block[p.upper_slot[u]]));
      flush(a, c_.weight[i]);
    }
    for (int m = 0; m < 4; ++m)
      if (c_.coarse_value[4 * a + m][m] == 0)  // the function is zero
        coarse_.block[c_.pattern.diagonal(4 * a + m)] = identity3<double>();
  }

 private:
  void clear(int a) {
    const BlockPattern& p = c_.pattern;
    std::fill(coarse_.block.begin() + p.row_start[4 * a], coarse_.block.begin() + p.row_start[4 * a + 4], Mat3d{});
  }

  void add(int a, int j, const Mat3d& H) {
    const int b = c_.aggregate[j];
    if (b < 0 || b > a) return;  // the coarse matrix is stored by its lower triangle
    if (place_[b] < 0) {
      place_[b] = static_cast<int>(sums_.size());
      sums_.push_back({b, {}});
    }
    RowSums& sum = sums_[place_[b]];
    for (int n = 0; n < 4; ++n) add_scaled(c_.weight[j][n], H, sum.value[n]);
  }

  void flush(int a, const FourValues& w) {
    const BlockPattern& p = c_.pattern;
    for (const RowSums& sum : sums_) {
      place_[sum.aggregate] = -1;
      for (int m = 0; m < 4; ++m) {
        const int row = 4 * a + m;
        const int columns = sum.aggregate == a ? m + 1 : 4;
        Mat3d* to = &coarse_.block[sum.aggregate == a ? p.diagonal(row) - m : p.slot(row, 4 * sum.aggregate)];
        for (int n = 0; n < columns; ++n) add_scaled(w[m], sum.value[n], to[n]);
      }
    }
  }

  const AffineCoarsening& c_;
  const BlockSparse& fine_;
  BlockSparse& coarse_;
  std::vector<int>& place_;
  std::vector<RowSums>& sums_;
};

void MatrixRestriction::reserve(const AffineCoarsening& c) {
  size_t most = 0;
  for (int a = 0; a < c.count(); ++a) most = std::max(most, c.graph.around(a).size());
  scratch_.resize(kTasks);
  for (Scratch& scratch : scratch_) {
    scratch.place.assign(c.count(), -1);
    scratch.sums.reserve(most + 1);
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
