// The inverses of the 3x3 diagonal blocks.
#pragma once
#include <span>
#include <vector>

#include "linalg/approximate_inverse.h"

namespace aspic {

class BlockJacobi : public ApproximateInverse {
 public:
  // What becomes of diagonal blocks that are not positive definite.
  enum class Blocks { as_they_are, made_definite };

  explicit BlockJacobi(Blocks blocks = Blocks::as_they_are) : blocks_(blocks) {}
  std::string_view name() const override { return "block_jacobi"; }
  void analyze(const BlockPattern& pattern) override { inverse_.resize(pattern.rows()); }
  bool factorize(const BlockSparse& H) override;  // false: a diagonal block is not positive definite, nor made so
  void apply(std::span<const double> r, std::span<double> z) override;

 private:
  Blocks blocks_;
  std::vector<Mat3d> inverse_;
};

// The inverse of a symmetric matrix by its lower triangle; false when it is not (numerically) positive definite.
bool invert_positive_definite(const Mat3d& A, Mat3d& inverse);

// The same for a symmetric matrix whose eigenvalues l are first replaced by max(|l|, floor), floor a small part of the
// largest |l|, if A is not positive definite as it is. False for a matrix that is zero or not finite.
bool invert_made_definite(const Mat3d& A, Mat3d& inverse);

// z = D^-1 r block by block, D^-1 by its 3x3 blocks.
void multiply_blocks(std::span<const Mat3d> blocks, std::span<const double> r, std::span<double> z);

}  // namespace aspic
