#include "linalg/auto_solver.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/formatted.h"
#include "base/free_memory.h"
#include "base/parallel.h"
#include "linalg/multigrid.h"

namespace aspic {
namespace {

// Costs in block-Jacobi iterations (25 ns per row on one AVX-512 core; ratios differ little between machines), fit to
// the bodies of tests/bench/auto.py. A factorization of f flops per row costs f / kFlopsPerIteration + kSmallFronts
// sqrt(f): small fronts run slower. Multigrid costs kCycleCost per cycle, and kMultigridCost for two digits.
constexpr double kFlopsPerIteration = 1500, kSmallFronts = 0.55;
constexpr double kFew = 3e7;  // flops, a millisecond, below which the more robust factorization is preferred
constexpr double kCycleCost = 5, kMultigridCost = 40;
constexpr double kLoose = 1.5;          // inexact solves are followed by more Newton iterations than exact ones
constexpr double kLifted = 6;           // the same with stiff rows, whose pressures cost iterations, too
constexpr double kRoundOff = 1e-12;     // round-off of a sum of canceling entries, relative to the diagonal
constexpr double kIterations = 4;       // fit to beams of 425 to 12 825 vertices, E = 1e4 to 1e8
constexpr int kBlockJacobiCap = 300;    // maximum iterations before the next choice
constexpr int kLastChoiceCap = 10'000;  // maximum iterations without a next choice

// Finds the rows of vertices that are fixed along some direction n: all their couplings K satisfy n'K = 0. If all
// couplings of all rows satisfy it, as in a chain of springs, no row is marked.
void find_held_rows(const BlockSparse& H, std::vector<char>& held) {
  constexpr double kFlat = 1e-14;  // determinant relative to the cube of the trace; its round-off is below 1e-16
  const BlockPattern& p = *H.pattern;
  held.assign(p.rows(), 0);
  parallel_chunks(p.rows(), [&](int first, int last) {
    for (int row = first; row < last; ++row) {
      Mat3d squares{};
      for (int64_t s = p.row_start[row]; s < p.diagonal(row); ++s)
        squares = squares + H.block[s] * transpose(H.block[s]);
      for (int64_t u = p.upper_start[row]; u < p.upper_start[row + 1]; ++u)
        squares = squares + transpose(H.block[p.upper_slot[u]]) * H.block[p.upper_slot[u]];
      const double size = trace(squares);
      held[row] = size == 0 || determinant((1 / size) * squares) <= kFlat;
    }
  });
  if (std::all_of(held.begin(), held.end(), [](char h) { return h; })) std::fill(held.begin(), held.end(), 0);
}

std::string approximate(double value) { return formatted("%.2g", value); }

}  // namespace

double predict_iterations(const BlockSparse& H) {
  std::vector<char> held;
  return predict_iterations(H, held);
}

double predict_iterations(const BlockSparse& H, std::vector<char>& held) {
  return predict_iterations(uniform_stiffness(H, H.pattern->rows(), held));
}

UniformStiffness uniform_stiffness(const BlockSparse& H, int rows, std::vector<char>& held) {
  const BlockPattern& p = *H.pattern;
  find_held_rows(H, held);
  held.resize(2 * static_cast<size_t>(p.rows()));
  char* const beside_pin = held.data() + p.rows();
  const double uniform = parallel_sum(rows, [&](int first, int last) {
    double total = 0;
    for (int row = first; row < last; ++row) {
      double sum = trace(H.block[p.diagonal(row)]);
      bool is_beside = held[row];
      const auto add = [&](int64_t slot, int neighbor) {
        sum += trace(H.block[slot]);
        is_beside = is_beside || held[neighbor] || squared_norm(H.block[slot]) == 0;
      };
      for (int64_t s = p.row_start[row]; s < p.diagonal(row); ++s) add(s, p.column[s]);
      for (int64_t u = p.upper_start[row]; u < p.upper_start[row + 1]; ++u) add(p.upper_slot[u], p.upper_row[u]);
      beside_pin[row] = is_beside;
      if (!is_beside) total += sum;
    }
    return total;
  });
  const double diagonal = parallel_sum(rows, [&](int first, int last) {
    double total = 0;
    for (int row = first; row < last; ++row)
      if (!beside_pin[row]) total += trace(H.block[p.diagonal(row)]);
    return total;
  });
  return {uniform, diagonal};
}

double predict_iterations(const UniformStiffness& stiffness) {
  const auto [uniform, diagonal] = stiffness;
  const double round_off = kRoundOff * diagonal;
  if (!(diagonal > 0) || uniform < -round_off) return 1;  // an indefinite matrix is detected after few iterations
  return uniform > round_off ? kIterations * std::sqrt(diagonal / uniform) : std::numeric_limits<double>::infinity();
}

AutoSolver::AutoSolver(int64_t memory_limit, int solves)
    : memory_limit_(memory_limit),
      solves_(solves),
      cholesky_(memory_limit),
      block_jacobi_(kBlockJacobiCap),
      multigrid_(std::make_unique<Multigrid>()),
      solver_{&block_jacobi_, &multigrid_, &cholesky_} {}

void AutoSolver::analyze(const BlockPattern& pattern) {
  pattern_ = &pattern;
  H_ = nullptr;
  is_analyzed_ = {};
  is_chosen_ = has_chosen_ = false;
  prediction_ = predict_cholesky(pattern);
  fits_ = prediction_.bytes() < static_cast<double>(std::min(memory_limit_, free_memory()));
  const int rows = std::max(1, pattern.rows());
  const double f = prediction_.flops / rows;
  affordable_ = f / kFlopsPerIteration;
  if (prediction_.flops > kFew) affordable_ += kSmallFronts * std::sqrt(f);
  affordable_ /= solves_;
  // Cycles that cost as much as a factorization.
  multigrid_.set_max_iterations(fits_ ? static_cast<int>(std::ceil(affordable_ / kCycleCost)) : kLastChoiceCap);
}

void AutoSolver::begin() {
  is_chosen_ = false;
  cycles_ = tries_ = 0;
  for (LinearSolver* solver : solver_) solver->begin();
}

AutoSolver::Choice AutoSolver::cheapest(const BlockSparse& H) {
  expected_ = 0;
  if (fits_ && affordable_ <= kLoose) return kCholesky;
  expected_ = predict_iterations(H, held_);
  const bool is_lifted = stiff_ && !stiff_->empty();
  const double iterative = (is_lifted ? kLifted : kLoose) * std::min(expected_, kMultigridCost);
  if (fits_ && affordable_ <= iterative) return kCholesky;
  return expected_ <= kMultigridCost ? kBlockJacobi : kMultigrid;
}

bool AutoSolver::factorize_with_choice() {
  LinearSolver& solver = *solver_[choice_];
  if (choice_ == kMultigrid) ++tries_;
  if (!is_analyzed_[choice_]) solver.analyze(*pattern_);
  is_analyzed_[choice_] = true;
  if (solver.factorize(*H_)) return true;
  if (choice_ != kCholesky || !cholesky_.refused()) return false;
  fits_ = false;  // the prediction was too low
  multigrid_.set_max_iterations(kLastChoiceCap);
  choice_ = kMultigrid;
  return factorize_with_choice();
}

bool AutoSolver::factorize(const BlockSparse& H) {
  H_ = &H;
  if (!is_chosen_) choice_ = cheapest(H);
  if (kCycleCost * cycles_ < affordable_ * tries_) choice_ = kMultigrid;  // the last failure was an exception
  const bool has_stiff_rows = !H.stencils.empty() || (stiff_ && !stiff_->empty());
  if (choice_ == kBlockJacobi && has_stiff_rows) choice_ = kMultigrid;  // the prediction ignores them
  is_chosen_ = has_chosen_ = true;
  return factorize_with_choice();
}

// Selects the next choice. Returns false if there is none.
bool AutoSolver::fall_back() {
  if (choice_ == kCholesky || (choice_ == kMultigrid && !fits_)) return false;
  choice_ = choice_ == kBlockJacobi ? kMultigrid : kCholesky;
  ++fallbacks_;
  return true;
}

SolveReport AutoSolver::solve(std::span<const double> b, std::span<double> x, double tolerance) {
  ASPIC_CHECK(H_);
  SolveReport total;
  for (;;) {
    const SolveReport report = solver_[choice_]->solve(b, x, tolerance);
    total.ok = report.ok;
    total.indefinite = report.indefinite;
    total.relative_residual = report.relative_residual;
    total.iterations += report.iterations;  // includes failed attempts
    total.products += report.products;
    total.cycles += report.cycles;
    cycles_ += report.cycles;
    total.stopped = report.stopped;
    if (report.ok || report.indefinite || report.stopped || !std::isfinite(report.relative_residual) || !fall_back())
      return total;
    if (factorize_with_choice()) continue;
    total.indefinite = true;
    return total;
  }
}

Cholesky* as_cholesky(LinearSolver& solver) {
  auto* choice = dynamic_cast<AutoSolver*>(&solver);
  return choice ? as_cholesky(choice->chosen()) : dynamic_cast<Cholesky*>(&solver);
}

std::string AutoSolver::description() const {
  if (!has_chosen_) return "auto";
  const std::string flops = "a factorization needs about " + approximate(prediction_.flops) + " flops";
  std::string text = "auto: " + chosen().description() + ", since ";
  text += fits_ ? flops
                : "a factor needs about " + approximate(prediction_.bytes() / 1e6) + " MB, more than the free memory";
  if (expected_ > 0)
    text += std::isfinite(expected_) ? " and block_jacobi about " + approximate(expected_) + " iterations"
                                     : " and block_jacobi is unlikely to converge";
  return fallbacks_ ? text + "; choices that did not converge: " + std::to_string(fallbacks_) : text;
}

}  // namespace aspic
