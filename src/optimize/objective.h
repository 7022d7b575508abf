// What a minimiser sees: a function with derivatives. No physics here.
#pragma once
#include <span>

#include "linalg/block_sparse.h"

namespace aspic {

// What a Hessian may be asked to be; the objective decides how (see Definiteness of the energies).
enum class HessianKind { exact, clamped, absolute };

class Objective {
 public:
  virtual ~Objective() = default;
  virtual double value(std::span<const double> x) = 0;  // +inf where it is not defined
  virtual void gradient(std::span<const double> x, std::span<double> g) = 0;
  virtual const BlockSparse& hessian(std::span<const double> x, HessianKind kind) = 0;
  virtual double max_step(std::span<const double>, std::span<const double>) {
    return 1e300;
  }  // largest feasible alpha along d

  // The size against which the last gradient is small or large, in its own units, and the part of it that is
  // round-off. A plain function measures against 1.
  virtual double gradient_scale() const { return 1; }
  virtual double gradient_round_off() const { return 0; }
  virtual double value_round_off() const { return 0; }  // of the last value

  virtual double dot(std::span<const double> a,
                     std::span<const double> b);  // a distributed objective reduces over ranks
};

}  // namespace aspic
