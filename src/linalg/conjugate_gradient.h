// Conjugate gradients, preconditioned with the inverses of the 3x3 diagonal blocks (block-Jacobi).
#pragma once
#include "linalg/linear_solver.h"

namespace aspic {

class ConjugateGradient : public LinearSolver {
 public:
  // What becomes of diagonal blocks that are not positive definite, in the preconditioner.
  enum class Blocks { as_they_are, made_definite };

  explicit ConjugateGradient(int max_iterations = 10'000) : max_iterations_(max_iterations) {}
  explicit ConjugateGradient(Blocks blocks) : blocks_(blocks) {}
  void set_max_iterations(int count) { max_iterations_ = count; }

  std::string_view name() const override { return "block_jacobi"; }
  void set_deadline(const Deadline& deadline) override { deadline_ = deadline; }
  void analyze(const BlockPattern& pattern) override;
  bool factorize(const BlockSparse& H) override;  // false: a diagonal block is not positive definite, nor made so
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

  Blocks blocks_ = Blocks::as_they_are;
  int max_iterations_ = 10'000;
  Deadline deadline_;
  const BlockSparse* H_ = nullptr;
  std::vector<Mat3d> inverse_diagonal_;
  std::vector<double> r_, z_, p_, q_;
  std::vector<Sums> partial_;  // one per chunk, added in order: the same bits for any number of threads
};

// The inverse of a symmetric matrix by its lower triangle; false when it is not (numerically) positive definite.
bool invert_positive_definite(const Mat3d& A, Mat3d& inverse);

// The same for a symmetric matrix whose eigenvalues l are first replaced by max(|l|, floor), floor a small part of the
// largest |l|, if A is not positive definite as it is. False for a matrix that is zero or not finite.
bool invert_made_definite(const Mat3d& A, Mat3d& inverse);

// z = D^-1 r block by block, D^-1 by its 3x3 blocks.
void multiply_blocks(std::span<const Mat3d> blocks, std::span<const double> r, std::span<double> z);

}  // namespace aspic
