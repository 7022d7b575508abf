// Energy densities that are infinite in inverted elements. Other lanes of a Pack are unaffected.
#pragma once
#include <limits>

#include "math/pack.h"

namespace aspic {

// Returns `energy` if J > 0, else +inf, also if J is NaN.
template <class T>
T infinite_unless_positive(const T& J, const T& energy) {
  return where_positive(J, energy, T(std::numeric_limits<double>::infinity()));
}

}  // namespace aspic
