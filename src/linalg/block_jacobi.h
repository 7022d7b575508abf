// Block-Jacobi preconditioner: the inverses of the 3x3 diagonal blocks.
#pragma once
#include <span>
#include <vector>

#include "linalg/approximate_inverse.h"

namespace aspic {

class BlockJacobi : public ApproximateInverse {
 public:
  // Treatment of diagonal blocks that are not positive definite.
  enum class Blocks { exact, modified };

  explicit BlockJacobi(Blocks blocks = Blocks::exact) : blocks_(blocks) {}
  std::string_view name() const override { return "block_jacobi"; }
  void analyze(const BlockPattern& pattern) override { inverse_.resize(pattern.rows()); }
  bool factorize(const BlockSparse& H) override;  // false: a block cannot be inverted
  void apply(std::span<const double> r, std::span<double> z) override;

 private:
  Blocks blocks_;
  std::vector<Mat3d> inverse_;
};

// Inverts a symmetric matrix, given its lower triangle. Returns false if it is not (numerically) positive definite.
bool invert_positive_definite(const Mat3d& A, Mat3d& inverse);

// Inverts a symmetric matrix. If it is not positive definite, first replaces its eigenvalues l by max(|l|, floor),
// where floor is a small fraction of the largest |l|. Returns false if A is zero or not finite.
bool invert_modified(const Mat3d& A, Mat3d& inverse);

// Computes z = D^-1 r, where `blocks` are the 3x3 blocks of D^-1.
void multiply_blocks(std::span<const Mat3d> blocks, std::span<const double> r, std::span<double> z);

}  // namespace aspic
