// A preconditioner of conjugate gradients: M^-1, an approximate inverse of a symmetric positive definite matrix H.
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "linalg/block_sparse.h"

namespace aspic {

class ApproximateInverse {
 public:
  virtual ~ApproximateInverse() = default;
  virtual std::string_view name() const = 0;
  virtual std::string description() const { return std::string(name()); }
  virtual void analyze(const BlockPattern& pattern) = 0;
  virtual bool factorize(const BlockSparse& H) = 0;  // returns false if H is detected not to be positive definite
  virtual void apply(std::span<const double> r, std::span<double> z) = 0;  // z = M^-1 r; r, z: 3 entries per row
  // Whether M^-1 is slightly nonlinear, which requires a flexible iteration, and costly to set up, so that it is reused
  // for related matrices.
  virtual bool is_multigrid() const { return false; }
};

}  // namespace aspic
