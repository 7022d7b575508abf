// Chooses between a factorisation and conjugate gradients by predicted cost.
#pragma once
#include "linalg/cholesky.h"
#include "linalg/conjugate_gradient.h"

namespace aspic {

// What a Cholesky factorisation will cost, from the graph alone and in linear time, without an elimination order.
struct CostPrediction {
  double flops = 0;
  double bytes = 0;
};
CostPrediction predict_cholesky(const BlockPattern& pattern);

// Iterations that block-Jacobi conjugate gradients will take for two digits, from how much softer a uniform
// displacement is than the diagonal: time steps of soft bodies are easy, since the mass dominates; stiff bodies and
// statics are hard.
double predict_iterations(const BlockSparse& H);

// Cholesky where a factorisation is cheaper than the predicted iterations. Otherwise conjugate gradients for as long as
// a factorisation would take, then, if they have not reached the tolerance and the factor fits into memory, Cholesky.
// The matrix at hand decides, never clocks or earlier matrices, so a resumed run takes the same path; only where the
// factor comes close to the memory that is free may two runs differ.
class AutoSolver : public LinearSolver {
 public:
  // `solves`: how many right-hand sides share a factorisation, roughly.
  explicit AutoSolver(int64_t memory_limit = std::numeric_limits<int64_t>::max(), int solves = 1);

  std::string_view name() const override { return "auto"; }
  std::string description() const override;
  void set_deadline(const Deadline& deadline) override { cg_.set_deadline(deadline); }
  void analyze(const BlockPattern& pattern) override;
  bool factorize(const BlockSparse& H) override;
  SolveReport solve(std::span<const double> b, std::span<double> x, double tolerance) override;

  bool is_direct() const { return direct_; }  // Cholesky at once
  int64_t fallbacks() const { return fallbacks_; }

 private:
  enum class Factor { none, ready, indefinite, refused };
  Factor factorize_directly();
  std::string expected() const;

  int64_t memory_limit_;
  int solves_;
  Cholesky cholesky_;
  ConjugateGradient cg_;
  CostPrediction prediction_;
  int rows_ = 0, cap_ = 0;
  double affordable_ = 0;  // iterations per solve that cost as much as a factorisation
  double expected_ = 0;    // iterations for the matrix at hand
  bool direct_ = false, fits_ = false;
  const BlockSparse* H_ = nullptr;
  uint64_t analyzed_version_ = 0;  // of the pattern that cholesky_ has analyzed
  Factor factor_ = Factor::none;   // of *H_
  int64_t fallbacks_ = 0;
};

}  // namespace aspic
