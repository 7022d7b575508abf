// Interface of an energy whose Hessian couples many vertices, such as that of a closed volume.
#pragma once
#include "energy/energy.h"
#include "linalg/dense_rows.h"

namespace aspic {

class DenseEnergy {
 public:
  virtual ~DenseEnergy() = default;
  // Appends the rank-one parts of scale d2V/dx2, which add_hessian() leaves out. Their weights are positive.
  virtual void add_dense_rows(Positions x, const Energy::Context& context, double scale, DenseRows& rows) const = 0;
};

}  // namespace aspic
