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
  // A multigrid cycle: in single precision and not quite linear, which the iteration has to allow for; costly to make.
  virtual bool is_multigrid() const { return false; }
};

}  // namespace aspic
