// Interface of an energy whose Hessian has stiff rows, such as the volume term of nearly incompressible solids.
#pragma once
#include "energy/energy.h"
#include "linalg/stiff_rows.h"

namespace aspic {

class StiffEnergy {
 public:
  virtual ~StiffEnergy() = default;
  // Appends the stiff rows of scale d2V/dx2, which add_hessian() includes.
  virtual void add_stiff_rows(Positions x, double scale, StiffRows& rows) const = 0;
};

}  // namespace aspic
