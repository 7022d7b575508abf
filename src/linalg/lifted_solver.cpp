#include "linalg/lifted_solver.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/check.h"
#include "base/parallel.h"
#include "math/vectors.h"

namespace aspic {
namespace {

constexpr int kRestart = 30;      // vectors of each basis
constexpr double kUseful = 0.99;  // reduction of the residual by a cycle

double along(const StiffRow& row, std::span<const double> x) {  // g . x
  double sum = 0;
  for (size_t n = 0; n < row.vertex.size(); ++n) sum += dot(row.g[n], vec_at(x, row.vertex[n]));
  return sum;
}

double mean_diagonal(const BlockSparse& A) {
  double sum = 0;
  for (int row = 0; row < A.pattern->rows(); ++row) sum += trace(A.block[A.pattern->diagonal(row)]) / 3;
  return sum > 0 ? sum / A.pattern->rows() : 1;
}

// A rotation of rows i and i + 1 of the Hessenberg matrix.
struct Rotation {
  double c, s;
  static Rotation that_clears(double above, double below) {
    const double length = std::hypot(above, below);
    return length > 0 ? Rotation{above / length, below / length} : Rotation{1, 0};
  }
  void apply(double& above, double& below) const {
    const double a = above;
    above = c * a + s * below;
    below = c * below - s * a;
  }
};

}  // namespace

void LiftedSolver::find_uses() {
  const BlockPattern& p = *H_->pattern;
  const auto is_same = [](const StiffRow& row, const auto& vertices) { return row.vertex == vertices; };
  if (version_ == p.version && std::equal(rows_->begin(), rows_->end(), vertices_.begin(), vertices_.end(), is_same))
    return;
  version_ = p.version;
  vertices_.clear();
  use_start_.assign(static_cast<size_t>(p.rows()) + 1, 0);
  for (const StiffRow& row : *rows_) {
    vertices_.push_back(row.vertex);
    for (const int v : row.vertex) ++use_start_[v + 1];
  }
  std::partial_sum(use_start_.begin(), use_start_.end(), use_start_.begin());
  uses_.resize(static_cast<size_t>(use_start_.back()));
  slots_.resize(uses_.size());
  std::vector<int> next(use_start_.begin(), use_start_.end() - 1);
  for (size_t e = 0; e < rows(); ++e)
    for (size_t n = 0; n < vertices_[e].size(); ++n)
      uses_[next[vertices_[e][n]]++] = {static_cast<int>(e), static_cast<int>(n), {}};
  parallel_chunks(p.rows(), [&](int first, int last) {
    for (int v = first; v < last; ++v)
      for (int u = use_start_[v]; u < use_start_[v + 1]; ++u)
        for (size_t m = 0; m < slots_[u].size(); ++m) {
          const int low = vertices_[uses_[u].row][m];
          slots_[u][m] = low > v ? -1 : p.slot(v, low);
        }
  });
}

template <class Visit>
void LiftedSolver::for_each_row(const Visit& visit) const {
  parallel_chunks(static_cast<int>(rows()), [&](int first, int last) {
    for (int e = first; e < last; ++e) visit(static_cast<size_t>(e));
  });
}

// x += sum over rows e of factor(e) g
template <class Factor>
void LiftedSolver::add_rows(const Factor& factor, std::span<double> x) {
  for_each_row([&](size_t e) { factor_[e] = factor(e); });
  parallel_chunks(static_cast<int>(use_start_.size()) - 1, [&](int first, int last) {
    for (int v = first; v < last; ++v)
      for (int u = use_start_[v]; u < use_start_[v + 1]; ++u) add_vec(factor_[uses_[u].row] * uses_[u].g, v, x);
  });
}

const BlockSparse& LiftedSolver::separate(const BlockSparse& H, const StiffRows& rows) {
  H_ = &H, rows_ = &rows;
  if (!A_ || A_->pattern != H.pattern) A_.emplace(*H.pattern);
  A_->block = H.block;
  A_->stencils = H.stencils;
  find_uses();
  parallel_chunks(H.pattern->rows(), [&](int first, int last) {  // A -= weight g g'
    for (int u = use_start_[first]; u < use_start_[last]; ++u) {
      const StiffRow& row = rows[uses_[u].row];
      uses_[u].g = row.g[uses_[u].place];
      for (size_t m = 0; m < slots_[u].size(); ++m) {
        if (slots_[u][m] < 0) continue;
        Mat3d& block = A_->block[slots_[u][m]];
        for (int c = 0; c < 3; ++c)
          for (int r = 0; r < 3; ++r) block(r, c) -= row.weight * (uses_[u].g[r] * row.g[m][c]);
      }
    }
  });
  const double stiffness = mean_diagonal(*A_);
  scale_.clear();
  for (const StiffRow& row : rows) scale_.push_back(std::sqrt(stiffness / (row.compliance + 1 / row.weight)));
  const size_t size = 3 * static_cast<size_t>(H.pattern->rows()) + rows.size();
  v_.resize(kRestart + 1), z_.resize(kRestart);
  for (auto* basis : {&v_, &z_})
    for (std::vector<double>& v : *basis)
      if (v.size() != size) v.clear();
  t_.resize(size);
  factor_.resize(rows.size());
  primal_.resize(size - rows.size()), right_.resize(size - rows.size());
  return *A_;
}

// w = [A B'; B -D^-1] z in units of scale_.
void LiftedSolver::apply(std::span<const double> z, std::span<double> w) {
  const size_t n = primal_.size();
  A_->multiply(z.first(n), w.first(n));
  const auto p = [&](size_t e) { return scale_[e] * z[n + e]; };
  add_rows(p, w.first(n));
  for_each_row([&](size_t e) {
    const StiffRow& row = (*rows_)[e];
    w[n + e] = scale_[e] * (along(row, z.first(n)) - p(e) / row.weight);
  });
}

void LiftedSolver::apply_preconditioner(std::span<const double> r, std::span<double> z,
                                        const Precondition& precondition) {
  const size_t n = primal_.size();
  std::copy_n(r.begin(), n, right_.begin());
  const auto p = [&](size_t e) {
    const StiffRow& row = (*rows_)[e];
    return -r[n + e] / scale_[e] / (row.compliance + 1 / row.weight);
  };
  for_each_row([&](size_t e) { z[n + e] = p(e) / scale_[e]; });
  add_rows([&](size_t e) { return -p(e); }, right_);
  precondition(right_, z.first(n));
}

// The residual of H d = b is r_d + B'D r_p.
double LiftedSolver::primal_norm(std::span<const double> r, double factor) {
  const size_t n = primal_.size();
  std::copy_n(r.begin(), n, primal_.begin());
  add_rows([&](size_t e) { return (*rows_)[e].weight * r[n + e] / scale_[e]; }, primal_);
  return std::abs(factor) * norm(primal_);
}

struct LiftedSolver::Cycle {
  double target;  // of the primal residual
  SolveReport& report;
  std::vector<double>&x, &r;                                   // solution and residual of the lifted system
  std::array<std::array<double, kRestart + 1>, kRestart> h{};  // columns of the triangular factor
  std::array<Rotation, kRestart> rotation{};
  std::array<double, kRestart + 1> right{};
  int size = 0;

  // Solves the triangular system.
  std::vector<double> coefficients() const {
    std::vector<double> y(right.begin(), right.begin() + size);
    for (int i = size - 1; i >= 0; --i) {
      for (int j = i + 1; j < size; ++j) y[i] -= h[j][i] * y[j];
      y[i] /= h[i][i];
    }
    return y;
  }
};

// Improves cycle.x, with the residual cycle.r. Returns whether no further cycle is needed.
bool LiftedSolver::run(Cycle& cycle, const Precondition& precondition) {
  const size_t size = cycle.r.size();
  const double start = norm(cycle.r);
  v_[0] = cycle.r;
  for (double& vi : v_[0]) vi /= start;
  t_ = v_[0];
  cycle.right[0] = start;
  bool is_done = false;
  for (int j = 0; j < kRestart && !is_done; ++j) {
    z_[j].resize(size), v_[j + 1].resize(size);
    apply_preconditioner(v_[j], z_[j], precondition);
    ++cycle.report.iterations, ++cycle.report.products;
    std::vector<double>& w = v_[j + 1];
    apply(z_[j], w);
    auto& h = cycle.h[j];
    for (int i = 0; i <= j; ++i) {
      h[i] = dot(w, v_[i]);
      add_scaled(-h[i], v_[i], w);
    }
    h[j + 1] = norm(w);
    const double below = h[j + 1];
    for (int i = 0; i < j; ++i) cycle.rotation[i].apply(h[i], h[i + 1]);
    Rotation& rotation = cycle.rotation[j] = Rotation::that_clears(h[j], h[j + 1]);
    rotation.apply(h[j], h[j + 1]);
    rotation.apply(cycle.right[j], cycle.right[j + 1]);
    cycle.size = j + 1;
    is_done = !(below > 0) || cycle.report.iterations >= max_iterations_;  // an exact solution, or NaN
    if (!(below > 0)) break;
    parallel_chunks(static_cast<int>(size), [&](int first, int last) {
      for (int i = first; i < last; ++i) {
        w[i] /= below;
        t_[i] = rotation.c * w[i] - rotation.s * t_[i];
      }
    });
    is_done = is_done || primal_norm(t_, cycle.right[j + 1]) <= cycle.target;
    cycle.report.stopped = stop_.stopped();
    is_done = is_done || cycle.report.stopped;
  }
  const std::vector<double> y = cycle.coefficients();
  for (int j = 0; j < cycle.size; ++j) add_scaled(y[j], z_[j], cycle.x);
  return is_done;
}

SolveReport LiftedSolver::solve(std::span<const double> b, std::span<double> x, double tolerance,
                                const Precondition& precondition) {
  ASPIC_CHECK(H_ && b.size() == primal_.size());
  SolveReport report;
  std::fill(x.begin(), x.end(), 0.0);
  const double size = norm(b);
  if (size == 0) {
    report.ok = true;
    return report;
  }
  std::vector<double> lifted(t_.size(), 0.0), r(t_.size(), 0.0);
  std::copy(b.begin(), b.end(), r.begin());
  for (double before = INFINITY;;) {
    Cycle cycle{tolerance * size, report, lifted, r};
    const bool is_done = run(cycle, precondition);
    apply(lifted, r);
    ++report.products;
    for (size_t i = 0; i < r.size(); ++i) r[i] = (i < b.size() ? b[i] : 0) - r[i];
    const double residual = primal_norm(r, 1);
    if (is_done || !(residual < kUseful * before)) break;
    before = residual;
  }
  std::copy_n(lifted.begin(), x.size(), x.begin());
  judge(b, x, tolerance, report);
  return report;
}

void LiftedSolver::judge(std::span<const double> b, std::span<const double> x, double tolerance, SolveReport& report) {
  H_->multiply(x, right_);
  ++report.products;
  const double curvature = dot(x, right_), slope = dot(b, x);
  for (size_t i = 0; i < b.size(); ++i) primal_[i] = b[i] - right_[i];
  report.relative_residual = norm(primal_) / norm(b);
  report.indefinite = curvature <= 0 || slope <= 0;
  report.ok = !report.indefinite && !report.stopped && report.relative_residual <= 1.01 * tolerance;
}

}  // namespace aspic
