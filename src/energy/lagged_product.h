// The derivative of forces with lagged coefficients by these coefficients. It completes the Hessian of the term, at
// coefficients of the same x, to the derivative of its forces, which is not symmetric.
#pragma once
#include "energy/energy.h"

namespace aspic {

class LaggedProduct {
 public:
  virtual ~LaggedProduct() = default;
  // g += scale C dx and its transpose
  virtual void add_lagged_product(Positions x, std::span<const double> dx, double scale, std::span<double> g) const = 0;
  virtual void add_lagged_transposed(Positions x, std::span<const double> w, double scale,
                                     std::span<double> xbar) const = 0;
};

}  // namespace aspic
