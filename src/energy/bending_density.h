// Interface of terms whose elements bend: sheets and rods.
#pragma once
#include <span>

#include "energy/energy.h"

namespace aspic {

class BendingElements {
 public:
  virtual ~BendingElements() = default;
  // Adds the energy of bending, and of twist, per volume at rest of each element of the mesh [J/m^3]. `z`: the internal
  // variables of the term at x, if it has any.
  virtual void add_bending_density(Positions x, std::span<const double> z, std::span<double> density) const = 0;
};

}  // namespace aspic
