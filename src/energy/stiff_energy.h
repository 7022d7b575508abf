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
  // Until the next call or step, add_hessian() uses the pressures that are linearized at x for x + d instead of those
  // at its x: Newton's method for both displacement and pressure, which needs fewer iterations. Empty spans: none.
  virtual void note_newton_step(Positions x, std::span<const double> d, const Energy::Context& context) const = 0;
};

}  // namespace aspic
