// Interface of a dissipation potential with internal variables z, such as the stresses of Maxwell branches. They are
// part of the state: D depends on those at the start of the step, and a step ends with new ones.
#pragma once
#include <algorithm>
#include <cstddef>

#include "energy/energy.h"

namespace aspic {

// A term has the same number of internal variables in each of its tets, tet by tet.
struct InternalRange {
  int first_tet = 0, tet_count = 0;  // in the mesh; elements, for rods
  int per_tet = 0;

  size_t size() const { return static_cast<size_t>(tet_count) * per_tet; }
};

struct InternalStep {
  Positions start, end;           // x at the start and the end of the step
  std::span<const double> z_end;  // internal variables at its end
};

// Energies of a step [J].
struct InternalEnergies {
  double work = 0;  // dD/dx . (end - start), with dD/dx at the end
  double gain = 0;  // change of the stored energy
  double loss = 0;  // dissipation if strains are linear in time, >= 0
};

class InternalVariables {
 public:
  virtual ~InternalVariables() = default;
  virtual InternalRange internal_range() const = 0;
  // Writes the values at the start of a simulation at x; zeros by default.
  virtual void write_initial(Positions /*x*/, std::span<double> z) const { std::fill(z.begin(), z.end(), 0.0); }
  // Sets the values at the start of the step and its duration [s]. Called after begin_step(), which sets zeros and
  // StepContext::h. `z` must outlive the step; empty: zeros.
  virtual void begin_internal(std::span<const double> z, double duration, const Energy::Context& context) const = 0;
  // Writes the values at the end of a step that ends at x.
  virtual void end_internal(Positions x, const Energy::Context& context, std::span<double> z) const = 0;
  virtual double stored_energy(std::span<const double> z) const = 0;  // [J]
  virtual InternalEnergies internal_energies(const InternalStep& step, const Energy::Context& context) const = 0;
};

}  // namespace aspic
