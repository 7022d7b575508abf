// Chooses between a factorization and conjugate gradients, and their preconditioner, by predicted cost.
#pragma once
#include <array>

#include "linalg/cholesky.h"
#include "linalg/conjugate_gradient.h"

namespace aspic {

// What a Cholesky factorization will cost, from the graph alone and in linear time, without an elimination order.
struct CostPrediction {
  double flops = 0;
  double bytes = 0;
};
CostPrediction predict_cholesky(const BlockPattern& pattern);

// Iterations that block-Jacobi conjugate gradients will take for two digits, from how much softer a uniform
// displacement is than the diagonal: time steps of soft bodies are easy, since the mass dominates; stiff bodies and
// statics are hard.
double predict_iterations(const BlockSparse& H);
double predict_iterations(const BlockSparse& H, std::vector<char>& scratch);

// Predicts the cheapest solver for each sequence of matrices from its first one: a factorization, conjugate gradients
// with multigrid, or with block-Jacobi. A choice that turns out wrong is replaced by the next in the order
// block_jacobi, multigrid, cholesky, the last if its factor fits into memory. The matrices at hand decide, never clocks
// or earlier sequences, so a resumed run takes the same path; only where the factor comes close to the memory that is
// free may two runs differ.
class AutoSolver : public LinearSolver {
 public:
  // `solves`: how many right-hand sides share a factorization, roughly.
  explicit AutoSolver(int64_t memory_limit = std::numeric_limits<int64_t>::max(), int solves = 1);

  std::string_view name() const override { return "auto"; }
  std::string description() const override;  // the choice and its reason
  void set_stop(const StopToken& stop) override {
    for (LinearSolver* solver : solver_) solver->set_stop(stop);
  }
  void analyze(const BlockPattern& pattern) override;
  void begin() override;
  bool factorize(const BlockSparse& H) override;
  SolveReport solve(std::span<const double> b, std::span<double> x, double tolerance) override;

  LinearSolver& chosen() { return *solver_[choice_]; }
  const LinearSolver& chosen() const { return *solver_[choice_]; }
  int64_t fallbacks() const { return fallbacks_; }  // choices that turned out wrong

 private:
  enum Choice { kBlockJacobi, kMultigrid, kCholesky };
  Choice cheapest(const BlockSparse& H);
  bool factorize_with_choice();
  bool fall_back();

  int64_t memory_limit_;
  int solves_;
  Cholesky cholesky_;
  ConjugateGradient block_jacobi_, multigrid_;
  std::array<LinearSolver*, 3> solver_;
  std::array<bool, 3> is_analyzed_ = {};
  const BlockPattern* pattern_ = nullptr;
  const BlockSparse* H_ = nullptr;
  CostPrediction prediction_;
  bool fits_ = false;        // the factor, into memory
  double affordable_ = 0;    // iterations with block-Jacobi that cost as much as a factorization, per solve
  double expected_ = 0;      // iterations with block-Jacobi for two digits; 0: not looked at
  bool has_chosen_ = false;  // for a sequence of this pattern
  bool is_chosen_ = false;   // for this sequence
  Choice choice_ = kBlockJacobi;
  int64_t fallbacks_ = 0;
  std::vector<char> held_;  // scratch
};

// The factorization that a solver is, or has chosen; null: none.
Cholesky* as_cholesky(LinearSolver& solver);

}  // namespace aspic
