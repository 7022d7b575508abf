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
constexpr double kDirectUpTo = 300;  // iterations; easy systems need about as many
constexpr int kPatience = 10'000;    // iterations where there is nothing to fall back to

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

AutoSolver::AutoSolver(int64_t memory_limit) : memory_limit_(memory_limit), cholesky_(memory_limit) {}

void AutoSolver::analyze(const BlockPattern& pattern) {
  H_ = nullptr;
  rows_ = pattern.rows();
  prediction_ = predict_cholesky(pattern);
  fits_ = prediction_.bytes < static_cast<double>(std::min(memory_limit_, free_memory()));
  const double affordable = prediction_.flops / (kFlopsPerIteration * std::max(1, rows_));  // iterations
  direct_ = fits_ && affordable <= kDirectUpTo;
  cap_ = fits_ ? static_cast<int>(std::clamp(affordable, kDirectUpTo, double{kPatience})) : kPatience;
  cg_.set_max_iterations(cap_);
  if (direct_) {
    cholesky_.analyze(pattern);
    analyzed_version_ = pattern.version;
  } else {
    cg_.analyze(pattern);
  }
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
  if (direct_) {
    factor_ = factorize_directly();
    if (factor_ != Factor::refused) return factor_ == Factor::ready;
    direct_ = fits_ = false;  // the prediction was too low
    cg_.set_max_iterations(cap_ = kPatience);
    cg_.analyze(*H.pattern);
  }
  return cg_.factorize(H);
}

SolveReport AutoSolver::solve(std::span<const double> b, std::span<double> x, double tolerance) {
  ASPIC_CHECK(H_);
  if (factor_ == Factor::ready) return cholesky_.solve(b, x, tolerance);
  SolveReport report = cg_.solve(b, x, tolerance);
  if (report.ok || report.indefinite || !fits_ || !std::isfinite(report.relative_residual)) return report;
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

std::string AutoSolver::description() const {
  if (rows_ == 0) return "auto";
  const std::string flops = approximate(prediction_.flops) + " flops";
  if (direct_) return "auto: cholesky, since a factorisation takes only about " + flops;
  std::string text =
      "auto: block_jacobi for up to " + std::to_string(cap_) + " iterations, since a factorisation takes ";
  if (!fits_) return text + "about " + approximate(prediction_.bytes / 1e6) + " MB, more than is free";
  text += "about " + flops + "; then cholesky";
  return fallbacks_ ? text + " (so far " + std::to_string(fallbacks_) + " times)" : text;
}

}  // namespace aspic
