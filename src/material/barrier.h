// Energies that are infinite in inverted elements, without harm to the other lanes of a Pack.
#pragma once
#include <limits>

#include "math/pack.h"

namespace aspic {

// energy where J > 0, +inf elsewhere (NaN counts as elsewhere).
template <class T>
T infinite_unless_positive(const T& J, const T& energy) {
  return where_positive(J, energy, T(std::numeric_limits<double>::infinity()));
}

}  // namespace aspic
