// Conjugate gradients, preconditioned with the inverses of the 3x3 diagonal blocks (block-Jacobi).
#pragma once
#include "linalg/linear_solver.h"

namespace aspic {

class ConjugateGradient : public LinearSolver {
 public:
  explicit ConjugateGradient(int max_iterations = 10'000) : max_iterations_(max_iterations) {}
  void set_max_iterations(int count) { max_iterations_ = count; }

  std::string_view name() const override { return "block_jacobi"; }
  void analyze(const BlockPattern& pattern) override;
  bool factorize(const BlockSparse& H) override;  // false: a diagonal block is not positive definite
  // Where negative curvature is met, x is the iterate so far (at the first iteration: the preconditioned b), which
  // still is a descent direction for a gradient of -b.
  SolveReport solve(std::span<const double> b, std::span<double> x, double tolerance) override;

 private:
  struct Sums {
    double rr = 0, rz = 0;
  };
  double p_dot_q();
  Sums advance(std::span<double> x, double alpha);     // x += alpha p, r -= alpha q, z = M^-1 r
  Sums begin(std::span<const double> b);               // with q = H x: r = b - q, z = M^-1 r, p = z
  void precondition(int first, int last, Sums& sums);  // z = M^-1 r on these rows
  Sums add_partial_sums() const;

  int max_iterations_;
  const BlockSparse* H_ = nullptr;
  std::vector<Mat3d> inverse_diagonal_;
  std::vector<double> r_, z_, p_, q_;
  std::vector<Sums> partial_;  // one per chunk, added in order: the same bits for any number of threads
};

// The inverse of a symmetric matrix by its lower triangle; false when it is not (numerically) positive definite.
bool invert_positive_definite(const Mat3d& A, Mat3d& inverse);

}  // namespace aspic
