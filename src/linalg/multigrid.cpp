#include "linalg/multigrid.h"

#include <algorithm>
#include <numeric>

#include "base/check.h"
#include "base/parallel.h"
#include "linalg/triangular_solve.h"
#include "math/lanes.h"

namespace aspic {
namespace {

constexpr int kMaxLevels = 10;
// Minimum ratio of the functions of two levels, see function_count(); below it, more levels do not help.
constexpr int kMinReduction = 2;
constexpr double kRegular =
    1e-12;  // relative increase of the coarsest diagonal: the matrix of a free body without mass is singular
constexpr double kAccurate = 0.25;  // reduction of a coarse residual that is sufficient
constexpr int kAggregatesPerTask = 8;
// Conjugate-gradient steps on the first coarse level, and on deeper levels or with jumps of the modulus, where more
// steps do not help.
constexpr int kFirstSteps = 3, kSteps = 2;

void find_isolated_rows(const BlockSparse& H, std::vector<char>& isolated) {
  const BlockPattern& p = *H.pattern;
  isolated.assign(p.rows(), 1);
  for (int row = 0; row < p.rows(); ++row) {
    for (int64_t s = p.row_start[row]; s < p.diagonal(row) && isolated[row]; ++s)
      if (squared_norm(H.block[s]) != 0) isolated[row] = isolated[p.column[s]] = 0;
    for (int64_t u = p.upper_start[row]; u < p.upper_start[row + 1] && isolated[row]; ++u)
      if (squared_norm(H.block[p.upper_slot[u]]) != 0) isolated[row] = isolated[p.upper_row[u]] = 0;
  }
}

std::vector<Vec3d> centers(const Aggregates& aggregates, std::span<const Vec3d> position) {
  std::vector<Vec3d> center(aggregates.count());
  for (int a = 0; a < aggregates.count(); ++a) {
    Vec3d sum{};
    for (const int v : aggregates.members(a)) sum = sum + position[v];
    center[a] = (1.0 / static_cast<double>(aggregates.members(a).size())) * sum;
  }
  return center;
}

std::vector<double> averages(const Aggregates& aggregates, std::span<const double> value) {
  std::vector<double> average(value.empty() ? 0 : aggregates.count(), 0.0);
  for (size_t a = 0; a < average.size(); ++a) {
    const auto members = aggregates.members(static_cast<int>(a));
    for (const int v : members) average[a] += value[v] / static_cast<double>(members.size());
  }
  return average;
}

bool has_modulus_jump(const Graph& graph, std::span<const double> modulus) {
  if (modulus.empty()) return false;
  for (int v = 0; v < graph.vertex_count(); ++v)
    for (const int w : graph.around(v))
      if (is_modulus_jump(modulus[v], modulus[w])) return true;
  return false;
}

// Returns the values of (1, X, Y, Z) at the rows. Coarse functions are displacements: they are zero at rows of angles.
std::vector<FourValues> affine_values(const BlockPattern& pattern, std::span<const Vec3d> position) {
  std::vector<FourValues> value;
  for (const Vec3d& X : position) value.push_back({1, X[0], X[1], X[2]});
  std::fill(value.end() - pattern.angle_rows, value.end(), FourValues{});
  return value;
}

// Returns the number of coarse functions that are not zero: on a plane, the fourth of each aggregate is.
int function_count(const AffineCoarsening& coarsening) {
  int count = 0;
  for (size_t row = 0; row < coarsening.coarse_value.size(); ++row) count += coarsening.coarse_value[row][row % 4] != 0;
  return count;
}

std::vector<int> inverse_permutation(std::span<const int> order) {
  std::vector<int> place(order.size());
  for (size_t k = 0; k < order.size(); ++k) place[order[k]] = static_cast<int>(k);
  return place;
}

using QuadF = Quad<float>;

constexpr int kCoarseRows = 4, kCoarseEntries = 3 * kCoarseRows;  // per vertex of a coarse level
constexpr int kCoarseFloats = kFloatsPerRow * kCoarseRows;

// Calls visit(row, place) for the rows of the vertices of a group, numbered in the order of the visit, and the place of
// their first entries in a vector.
template <class Visit>
void for_each_row(const GaussSeidel& smoother, int group, const Visit& visit) {
  const auto [first, last] = smoother.vertices_of_group(group);
  const size_t rows = static_cast<size_t>(smoother.rows_per_vertex());
  for (size_t v = first; v < static_cast<size_t>(last); ++v)
    for (size_t m = 0; m < rows; ++m) visit(rows * v + m, kFloatsPerRow * rows * v + 3 * m);
}

template <class Body>
void for_each_aggregate(int count, const Body& body) {
  const auto task = [&](int t) {
    for (int a = kAggregatesPerTask * t; a < std::min(count, kAggregatesPerTask * (t + 1)); ++a) body(a);
  };
  parallel_for((count + kAggregatesPerTask - 1) / kAggregatesPerTask, task);
}

template <class Body>
void for_each_entry(std::span<const float> v, const Body& body) {
  parallel_chunks(static_cast<int>(v.size()), [&](int first, int last) {
    for (int i = first; i < last; ++i) body(i);
  });
}

// The inner product of vectors of a coarse level.
double dot(std::span<const float> a, std::span<const float> b) {
  static_assert(kChunkSize % kCoarseFloats == 0);
  return parallel_sum(static_cast<int>(a.size()), [&](int first, int last) {
    double sum = 0;
    for (int i = first; i < last; i += kCoarseFloats)
      for (int k = i; k < i + kCoarseEntries; ++k) sum += static_cast<double>(a[k]) * b[k];
    return sum;
  });
}

}  // namespace

void Multigrid::analyze(const BlockPattern& pattern) {
  pattern_ = &pattern;
  is_built_ = false;
}

void Multigrid::build(const BlockSparse& H) {
  levels_.clear();
  levels_.reserve(kMaxLevels + 1);  // levels point to the patterns of those above
  const BlockPattern* pattern = H.pattern;
  Graph graph = graph_of(*pattern);
  std::vector<Vec3d> position = pattern->rest_position;
  position.resize(pattern->rows());  // rows without a known position move with their aggregate
  std::vector<FourValues> value = affine_values(*pattern, position);
  int functions = pattern->rows();
  std::vector<double> modulus = pattern->rest_modulus;
  const int first_steps = has_modulus_jump(graph, modulus) ? kSteps : kFirstSteps;
  std::span<const char> excluded = isolated_;
  int rows_per_vertex = 1, size = options_.aggregate_size;
  while (pattern->rows() > options_.coarsest_rows && static_cast<int>(levels_.size()) < kMaxLevels) {
    Aggregates aggregates = make_aggregates({graph, position, modulus, excluded, size});
    // If the modulus jumps almost everywhere, aggregates cross the jumps; on the first level only if necessary.
    const int too_many = rows_per_vertex == 4 ? graph.vertex_count() / 3 : pattern->rows() / (4 * kMinReduction);
    if (aggregates.count() > too_many) aggregates = make_aggregates({graph, position, {}, excluded, size});
    AffineCoarsening coarsening = make_affine_coarsening(graph, aggregates, rows_per_vertex, value);
    const int coarse_functions = function_count(coarsening);
    if (coarse_functions == 0 || kMinReduction * coarse_functions > functions) break;
    functions = coarse_functions;
    Level& level = levels_.emplace_back();
    level.coarsening = std::move(coarsening);
    const AffineCoarsening& c = level.coarsening;
    level.smoother.analyze(*pattern, rows_per_vertex, aggregates.of_vertex, greedy_coloring(c.graph));
    level.restriction.reserve(c);
    level.coarse = std::make_unique<BlockSparse>(c.pattern);
    reserve_vectors(level, pattern->rows(), first_steps);

    position = centers(aggregates, position);
    value = c.coarse_value;
    graph = c.graph;
    modulus = averages(aggregates, modulus);
    excluded = {};
    rows_per_vertex = 4, size = options_.coarse_aggregate_size;
    pattern = &c.pattern;
  }
  const bool is_dense = pattern->rows() <= options_.coarsest_rows;
  if (!is_dense) {
    Level& level = levels_.emplace_back();
    std::vector<int> vertex(graph.vertex_count());
    std::iota(vertex.begin(), vertex.end(), 0);
    level.smoother.analyze(*pattern, rows_per_vertex, vertex, greedy_coloring(graph));
    reserve_vectors(level, pattern->rows(), first_steps);
  }
  connect_levels();
  const size_t rows = is_dense ? pattern->rows() : 0;
  for (auto* v : {&coarsest_b_, &coarsest_x_}) v->assign(kFloatsPerRow * rows, 0.0F);
  coarsest_.assign(3 * rows + kReadAhead, 0.0);
  factor_.assign(9 * rows * rows + kReadAhead, 0.0);
  dense_.reserve(static_cast<int>(3 * rows), static_cast<int>(3 * rows));
  is_built_ = true;
}

void Multigrid::reserve_vectors(Level& level, int rows, int first_steps) {
  const std::vector<float> zero(kFloatsPerRow * static_cast<size_t>(rows), 0.0F);
  level.b = level.x = level.r = zero;
  if (levels_.size() == 1) return;
  level.sum = level.before = zero;
  level.directions.assign(levels_.size() == 2 ? first_steps : kSteps, {zero, zero});
}

void Multigrid::connect_levels() {
  for (size_t l = 0; l < levels_.size(); ++l) {
    Level& level = levels_[l];
    if (!level.coarse) continue;
    level.weight.clear();
    const int rows_per_vertex = level.smoother.rows_per_vertex();
    for (const int v : level.smoother.order())
      for (int m = 0; m < rows_per_vertex; ++m)
        for (const double w : level.coarsening.weight[v * rows_per_vertex + m])
          level.weight.push_back(static_cast<float>(w));
    level.coarse_place.resize(level.coarsening.count());
    std::iota(level.coarse_place.begin(), level.coarse_place.end(), 0);
    if (l + 1 < levels_.size()) level.coarse_place = inverse_permutation(levels_[l + 1].smoother.order());
  }
}

bool Multigrid::factorize(const BlockSparse& H) {
  ASPIC_CHECK(pattern_ == H.pattern);
  find_isolated_rows(H, isolated_now_);
  if (!is_built_ || isolated_now_ != isolated_) {
    isolated_ = isolated_now_;
    build(H);
  }
  const BlockSparse* matrix = &H;
  for (Level& level : levels_) {
    if (!level.smoother.load(*matrix)) return false;
    if (!level.coarse) return true;
    level.restriction.run(level.coarsening, *matrix, *level.coarse);
    matrix = level.coarse.get();
  }
  return factorize_coarsest(*matrix);
}

bool Multigrid::factorize_coarsest(const BlockSparse& H) {
  const BlockPattern& p = *H.pattern;
  const size_t n = 3 * static_cast<size_t>(p.rows());
  std::fill(factor_.begin(), factor_.end(), 0.0);
  for (size_t row = 0; row < n / 3; ++row)
    for (int64_t s = p.row_start[row]; s < p.row_start[row + 1]; ++s)
      for (int k = 0; k < 9; ++k) {
        const size_t i = 3 * row + k % 3, j = 3 * static_cast<size_t>(p.column[s]) + k / 3;
        if (i >= j) factor_[i + j * n] = (i == j ? 1 + kRegular : 1) * H.block[s].a[k];
      }
  const int size = static_cast<int>(n);
  return dense_.factorize(factor_.data(), size, size, size);
}

void Multigrid::apply(std::span<const double> r, std::span<double> z) {
  const bool is_dense = levels_.empty();
  std::vector<float>& b = is_dense ? coarsest_b_ : levels_[0].b;
  const std::vector<float>& x = is_dense ? coarsest_x_ : levels_[0].x;
  const int rows = pattern_->rows();
  const auto row_at = [&](int k) { return 3 * static_cast<size_t>(is_dense ? k : levels_[0].smoother.order()[k]); };
  parallel_chunks(rows, [&](int first, int last) {
    for (int k = first; k < last; ++k)
      for (int i = 0; i < 3; ++i) b[kFloatsPerRow * static_cast<size_t>(k) + i] = static_cast<float>(r[row_at(k) + i]);
  });
  cycle(0);
  parallel_chunks(rows, [&](int first, int last) {
    for (int k = first; k < last; ++k)
      for (int i = 0; i < 3; ++i) z[row_at(k) + i] = x[kFloatsPerRow * static_cast<size_t>(k) + i];
  });
}

void Multigrid::cycle(int l) {
  if (l == static_cast<int>(levels_.size())) return solve_coarsest();
  Level& level = levels_[l];
  const bool is_last = l + 1 == static_cast<int>(levels_.size());
  level.smoother.sweep_forward(level.b.data(), level.x.data());
  if (!level.coarse) return sweep_backward(l);
  level.smoother.residual_after_forward(level.x.data(), level.r.data());
  restrict_residual(level, is_last ? coarsest_b_ : levels_[l + 1].b);
  solve(l + 1);
  add_prolonged(is_last ? coarsest_x_ : levels_[l + 1].x, level);
  sweep_backward(l);
}

void Multigrid::sweep_backward(int l) {
  Level& level = levels_[l];
  if (l > 0) level.before = level.x;
  level.smoother.sweep_backward(level.b.data(), level.x.data());
}

void Multigrid::solve(int l) {
  if (l == static_cast<int>(levels_.size())) return solve_coarsest();
  Level& level = levels_[l];
  std::vector<float>&x = level.x, &b = level.b;
  const double start = dot(b, b);
  std::fill(level.sum.begin(), level.sum.end(), 0.0F);
  for (size_t k = 0; k < level.directions.size(); ++k) {
    cycle(l);
    Direction& d = level.directions[k];
    level.smoother.multiply_after_backward(b.data(), level.before.data(), x.data(), d.q.data());
    for (size_t m = 0; m < k; ++m) {
      const Direction& before = level.directions[m];
      const float beta = static_cast<float>(dot(x, before.q) / before.pq);
      for_each_entry(x, [&](int i) { x[i] -= beta * before.p[i], d.q[i] -= beta * before.q[i]; });
    }
    d.pq = dot(x, d.q);
    if (!(d.pq > 0) && k == 0) return;
    if (!(d.pq > 0)) break;
    d.p = x;
    const float alpha = static_cast<float>(dot(x, b) / d.pq);
    for_each_entry(b, [&](int i) { level.sum[i] += alpha * d.p[i], b[i] -= alpha * d.q[i]; });
    if (dot(b, b) <= kAccurate * kAccurate * start) break;
  }
  x = level.sum;
}

void Multigrid::restrict_residual(const Level& level, std::span<float> coarse_b) const {
  for_each_aggregate(level.coarsening.count(), [&](int a) {
    QuadF sum[kCoarseRows] = {QuadF::zero(), QuadF::zero(), QuadF::zero(), QuadF::zero()};
    for_each_row(level.smoother, a, [&](size_t row, size_t place) {
      const QuadF r = QuadF::load(&level.r[place]);
      for (int m = 0; m < kCoarseRows; ++m) sum[m] += QuadF::all(level.weight[kCoarseRows * row + m]) * r;
    });
    float* to = &coarse_b[kCoarseFloats * static_cast<size_t>(level.coarse_place[a])];
    for (int m = 0; m < kCoarseRows; ++m) sum[m].store(to + 3 * m);  // the next one replaces the unused lane
  });
}

void Multigrid::add_prolonged(std::span<const float> coarse_x, Level& level) const {
  const QuadF used = {QuadF::Values{1, 1, 1, 0}};
  for_each_aggregate(level.coarsening.count(), [&](int a) {
    const float* x = &coarse_x[kCoarseFloats * static_cast<size_t>(level.coarse_place[a])];
    QuadF from[kCoarseRows];
    for (int m = 0; m < kCoarseRows; ++m) from[m] = used * QuadF::load(x + 3 * m);
    for_each_row(level.smoother, a, [&](size_t row, size_t place) {
      QuadF sum = QuadF::load(&level.x[place]);
      for (int m = 0; m < kCoarseRows; ++m) sum += QuadF::all(level.weight[kCoarseRows * row + m]) * from[m];
      sum.store(&level.x[place]);
    });
  });
}

void Multigrid::solve_coarsest() {
  const int n = 3 * static_cast<int>(coarsest_b_.size() / kFloatsPerRow);
  const int entries = levels_.empty() ? 3 : kCoarseEntries, floats = levels_.empty() ? kFloatsPerRow : kCoarseFloats;
  const auto place = [&](int i) { return static_cast<size_t>(floats) * (i / entries) + i % entries; };
  for (int i = 0; i < n; ++i) coarsest_[i] = coarsest_b_[place(i)];
  solve_forward(factor_.data(), n, n, coarsest_.data(), nullptr);
  solve_backward(factor_.data(), n, n, coarsest_.data(), nullptr);
  for (int i = 0; i < n; ++i) coarsest_x_[place(i)] = static_cast<float>(coarsest_[i]);
}

std::string Multigrid::description() const {
  if (!is_built_) return "multigrid";
  std::string rows;
  for (const Level& level : levels_) rows += (rows.empty() ? "" : ", ") + std::to_string(level.smoother.rows());
  if (ends_densely()) rows += (rows.empty() ? "" : ", ") + std::to_string(coarsest_b_.size() / kFloatsPerRow);
  return "multigrid on levels of " + rows + " rows";
}

}  // namespace aspic
