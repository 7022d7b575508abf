#include "linalg/auto_solver.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/check.h"
#include "linalg/free_memory.h"

namespace aspic {
namespace {

// Flops of a factorisation that take as long as one iteration of CG per row: 30 ns at 50 Gflop/s, both measured on one
// AVX-512 core; their ratio differs little between machines.
constexpr double kFlopsPerIteration = 1500;
constexpr double kDirectUpTo = 60;  // iterations; bodies of some 600 vertices are not worth a look at the matrix
constexpr double kIterations = 4;   // fit to beams of 425 to 12 825 vertices, E = 1e4 to 1e8
constexpr double kLoose = 3;        // a loose solve is followed by more Newton iterations than an exact one
constexpr int kLeastCap = 300;      // iterations before giving up
constexpr int kPatience = 10'000;   // iterations where there is nothing to fall back to

template <class Visit>
void for_each_neighbour(const BlockPattern& p, int row, Visit visit) {
  for (int64_t s = p.row_start[row]; s < p.diagonal(row); ++s) visit(p.column[s]);
  for (int64_t u = p.upper_start[row]; u < p.upper_start[row + 1]; ++u) visit(p.upper_row[u]);
}

// Breadth-first search from queue[begin]; appends what it reaches to the queue and returns the number of levels.
int search(const BlockPattern& p, std::vector<int>& queue, size_t begin, std::vector<int>& mark, int colour) {
  mark[queue[begin]] = colour;
  int levels = 0;
  for (size_t head = begin, level_end = queue.size(); head < queue.size(); level_end = queue.size(), ++levels)
    for (; head < level_end; ++head)
      for_each_neighbour(p, queue[head], [&](int row) {
        if (mark[row] != colour) mark[row] = colour, queue.push_back(row);
      });
  return levels;
}

std::string approximate(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", value);
  return text;
}

}  // namespace

// A component of n rows and s rows per breadth-first level: 150 n^2 flops if compact, 390 n s^1.5 if slender, and
// 100 n s^0.5 entries of L (fits to exact nested-dissection counts of boxes of 1 000 to 1 000 000 vertices and a beam,
// within a factor of two).
CostPrediction predict_cholesky(const BlockPattern& pattern) {
  CostPrediction cost;
  std::vector<int> mark(pattern.rows(), 0), queue;
  queue.reserve(pattern.rows());
  for (int start = 0; start < pattern.rows(); ++start) {
    if (mark[start] != 0) continue;
    const size_t begin = queue.size();
    queue.push_back(start);
    search(pattern, queue, begin, mark, 1);
    const int far = queue.back();  // a search from the far end sees the whole length of a slender body
    queue.resize(begin);
    queue.push_back(far);
    const int levels = search(pattern, queue, begin, mark, 2);
    const double n = static_cast<double>(queue.size() - begin), s = n / levels;
    cost.flops += std::min(150 * n * n, 390 * n * std::pow(s, 1.5));
    cost.bytes += 12 * 100 * n * std::sqrt(s);  // 8 per entry, and as much again by half for the update matrices
  }
  return cost;
}

double predict_iterations(const BlockSparse& H) {
  const BlockPattern& p = *H.pattern;
  double uniform = 0, diagonal = 0;  // 1' H 1 and 1' D 1, over the rows away from pinned vertices
  for (int row = 0; row < p.rows(); ++row) {
    double sum = 0;
    bool beside_pin = false;  // a coupling that was cleared
    const auto add = [&](int64_t slot) {
      sum += trace(H.block[slot]);
      beside_pin = beside_pin || squared_norm(H.block[slot]) == 0;
    };
    for (int64_t s = p.row_start[row]; s < p.diagonal(row); ++s) add(s);
    for (int64_t u = p.upper_start[row]; u < p.upper_start[row + 1]; ++u) add(p.upper_slot[u]);
    if (beside_pin) continue;
    const double own = trace(H.block[p.diagonal(row)]);
    uniform += sum + own;
    diagonal += own;
  }
  if (!(diagonal > 0) || uniform < 0) return 1;  // an indefinite matrix is found out soon
  return uniform > 0 ? kIterations * std::sqrt(diagonal / uniform) : std::numeric_limits<double>::infinity();
}

AutoSolver::AutoSolver(int64_t memory_limit, int solves)
    : memory_limit_(memory_limit), solves_(solves), cholesky_(memory_limit) {}

void AutoSolver::analyze(const BlockPattern& pattern) {
  H_ = nullptr;
  rows_ = pattern.rows();
  prediction_ = predict_cholesky(pattern);
  fits_ = prediction_.bytes < static_cast<double>(std::min(memory_limit_, free_memory()));
  affordable_ = prediction_.flops / (kFlopsPerIteration * solves_ * std::max(1, rows_));
  cap_ = fits_ ? static_cast<int>(std::clamp<double>(affordable_, kLeastCap, kPatience)) : kPatience;
  cg_.set_max_iterations(cap_);
  cg_.analyze(pattern);
  direct_ = false;
}

AutoSolver::Factor AutoSolver::factorize_directly() {
  if (analyzed_version_ != H_->pattern->version) {
    cholesky_.analyze(*H_->pattern);
    analyzed_version_ = H_->pattern->version;
  }
  if (cholesky_.factorize(*H_)) return Factor::ready;
  return cholesky_.refused() ? Factor::refused : Factor::indefinite;
}

bool AutoSolver::factorize(const BlockSparse& H) {
  H_ = &H;
  factor_ = Factor::none;
  expected_ = fits_ && affordable_ > kDirectUpTo && affordable_ < kPatience ? predict_iterations(H) : 0;
  direct_ = fits_ && (affordable_ <= kDirectUpTo || kLoose * expected_ > affordable_);
  if (direct_) {
    factor_ = factorize_directly();
    if (factor_ != Factor::refused) return factor_ == Factor::ready;
    direct_ = fits_ = false;  // the prediction was too low
    cg_.set_max_iterations(cap_ = kPatience);
  }
  return cg_.factorize(H);
}

SolveReport AutoSolver::solve(std::span<const double> b, std::span<double> x, double tolerance) {
  ASPIC_CHECK(H_);
  if (factor_ == Factor::ready) return cholesky_.solve(b, x, tolerance);
  SolveReport report = cg_.solve(b, x, tolerance);
  if (report.ok || report.indefinite || report.stopped || !fits_ || !std::isfinite(report.relative_residual))
    return report;
  if (factor_ == Factor::none) {
    ++fallbacks_;
    factor_ = factorize_directly();
  }
  report.indefinite = factor_ == Factor::indefinite;
  if (factor_ != Factor::ready) return report;
  const int iterations = report.iterations;
  report = cholesky_.solve(b, x, tolerance);
  report.iterations = iterations;  // what was tried first was paid for
  return report;
}

std::string AutoSolver::expected() const {
  if (expected_ == 0) return "";
  return std::isfinite(expected_) ? " (conjugate gradients: about " + approximate(expected_) + " iterations)"
                                  : " (conjugate gradients would hardly converge)";
}

std::string AutoSolver::description() const {
  if (rows_ == 0) return "auto";
  const std::string flops = approximate(prediction_.flops) + " flops";
  if (direct_) return "auto: cholesky, since a factorisation takes only about " + flops + expected();
  std::string text =
      "auto: block_jacobi for up to " + std::to_string(cap_) + " iterations, since a factorisation takes ";
  if (!fits_) return text + "about " + approximate(prediction_.bytes / 1e6) + " MB, more than is free";
  text += "about " + flops + expected() + "; then cholesky";
  return fallbacks_ ? text + " (so far " + std::to_string(fallbacks_) + " times)" : text;
}

}  // namespace aspic
