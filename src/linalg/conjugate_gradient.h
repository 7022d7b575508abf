// Preconditioned conjugate gradients; FGMRES for matrices with stiff rows.
#pragma once
#include "linalg/block_jacobi.h"
#include "linalg/lifted_solver.h"
#include "linalg/linear_solver.h"
#include "linalg/row_correction.h"

namespace aspic {

class ConjugateGradient : public LinearSolver {
 public:
  explicit ConjugateGradient(int max_iterations = 10'000);  // with block-Jacobi
  explicit ConjugateGradient(std::unique_ptr<ApproximateInverse> preconditioner, int max_iterations = 10'000);
  void set_max_iterations(int count);

  std::string_view name() const override { return preconditioner_->name(); }
  std::string description() const override { return preconditioner_->description(); }
  void set_stop(const StopToken& stop) override;
  void analyze(const BlockPattern& pattern) override;
  void begin() override { is_made_ = false; }
  void set_stiff_rows(const StiffRows* rows) override { stiff_ = rows; }
  // Sets up the preconditioner and returns whether it finds H positive definite. A costly preconditioner is reused for
  // the matrices of a sequence until the iterations per digit have grown by kTolerable.
  bool factorize(const BlockSparse& H) override;
  // If the iteration detects negative curvature, x is the last iterate (at the first iteration: the preconditioned b).
  // It is a descent direction for a function with the gradient -b.
  SolveReport solve(std::span<const double> b, std::span<double> x, double tolerance) override;

 private:
  bool is_lifted() const { return stiff_ && !stiff_->empty(); }
  SolveReport solve_lifted(std::span<const double> b, std::span<double> x, double tolerance);
  void note_rate(const SolveReport& report);
  void precondition(SolveReport& report);             // z = M^-1 r
  double advance(std::span<double> x, double alpha);  // x += alpha p, r -= alpha q; returns |r|
  void turn(double beta);                             // p = z + beta p
  double measure(std::span<const double> b, std::span<const double> x,
                 SolveReport& report);  // r = b - H x; returns |r|

  std::unique_ptr<ApproximateInverse> preconditioner_;
  RowCorrection correction_;  // for the stencils of H
  const StiffRows* stiff_ = nullptr;
  LiftedSolver lifted_;
  int max_iterations_ = 10'000;
  StopToken stop_;
  const BlockSparse* H_ = nullptr;
  bool is_made_ = false;  // the preconditioner, for this matrix or an earlier one
  double first_rate_ = 0,
         rate_ = 0;  // iterations per digit of the first and the last solve with this preconditioner; 0: none
  std::vector<double> r_, z_, p_, q_;
};

}  // namespace aspic
