// Derivatives of elastic forces with respect to the parameters theta of a term, see TetElasticity::parameter_count().
#pragma once
#include <memory>
#include <span>

#include "energy/tet_elasticity.h"

namespace aspic {

// Accumulators of derivatives. Empty spans are skipped.
struct HessianDerivatives {
  double scale = 1;
  std::span<double> x;           // 3 entries per vertex
  std::span<double> parameters;  // parameter_count() entries per tet
};

class ParameterDerivatives {
 public:
  virtual ~ParameterDerivatives() = default;
  // g += scale d(dV/dx)/dtheta change, and its transpose: gradient += scale d(w . dV/dx)/dtheta. `change` and
  // `gradient` have parameter_count() entries per tet, g and w 3 per vertex.
  virtual void add_force(Positions x, std::span<const double> change, double scale, std::span<double> g) const = 0;
  virtual void add_gradient(Positions x, std::span<const double> w, double scale, std::span<double> gradient) const = 0;
  // Adds scale times the derivatives of u . H(x) w with respect to x and theta, where H is the Hessian of the term's
  // add_hessian().
  virtual void add_hessian_derivatives(Positions x, std::span<const double> u, std::span<const double> w,
                                       Definiteness definiteness, const HessianDerivatives& out) const = 0;
};

// Derivatives at the current parameters of `term`, which must outlive them. Throws InvalidInput for an unknown kind of
// energy.
std::unique_ptr<ParameterDerivatives> derivatives_of(const TetElasticity& term);

}  // namespace aspic
