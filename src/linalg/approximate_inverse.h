// M^-1, a cheap stand-in for the inverse of a symmetric positive definite H: the preconditioner of conjugate gradients.
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
  virtual bool factorize(const BlockSparse& H) = 0;  // false: H is found not to be positive definite
  virtual void apply(std::span<const double> r, std::span<double> z) = 0;  // z = M^-1 r, 3 numbers per row
  // Not quite linear, for which the iteration has to allow, and costly to make, so that it is kept for related
  // matrices.
  virtual bool is_multigrid() const { return false; }
};

}  // namespace aspic
