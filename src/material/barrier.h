// Energies that are infinite in inverted elements; the other lanes of a Pack keep their values.
#pragma once
#include <limits>

#include "math/pack.h"

namespace aspic {

// Returns `energy` where J > 0, else +inf, also where J is NaN.
template <class T>
T infinite_unless_positive(const T& J, const T& energy) {
  return where_positive(J, energy, T(std::numeric_limits<double>::infinity()));
}

}  // namespace aspic
