// Small-strain elastic constants. Every material linearizes to these at rest.
#pragma once

namespace aspic {

// Lame's constants over a scalar: double, SIMD lanes, or a type with derivatives.
template <class T>
struct LameOver {
  T mu{}, lambda{};  // [Pa]
};
using Lame = LameOver<double>;

// Young's, shear and bulk moduli are in Pa. Requires -1 < poisson < 0.5.
inline Lame lame_from_young_poisson(double young, double poisson) {
  return {young / (2 * (1 + poisson)), young * poisson / ((1 + poisson) * (1 - 2 * poisson))};
}
inline Lame lame_from_shear_bulk(double shear, double bulk) { return {shear, bulk - 2 * shear / 3}; }
// Young's modulus [Pa]; NaN if mu = lambda = 0.
inline double young_modulus(Lame l) { return l.mu * (3 * l.lambda + 2 * l.mu) / (l.lambda + l.mu); }
// Poisson's ratio [1]; NaN if mu = lambda = 0.
inline double poisson_ratio(Lame l) { return l.lambda / (2 * (l.lambda + l.mu)); }

}  // namespace aspic
