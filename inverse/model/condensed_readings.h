// Condensation of dense readings of markers, such as those of image correlation. A marker is a fixed combination of the
// three corners of its triangle, so all residuals of a triangle are W x - y in terms of the positions x of its corners.
// With W = Q R, their squares add up to |R x - Q'y|^2 + |y - Q Q'y|^2 for every x: three readings per axis and a
// constant replace them. Values, derivatives and products J'J of a fit are equal up to round-off.
#pragma once
#include "model/misfit.h"

namespace aspic {

// Returns the experiment with condensed readings in the cases that have many, and other markers; see LoadCase::merged.
// The result is independent of the number of threads, and its size is bounded by that of the surface.
Condensed condensed(const Corrected& experiment);

// Whether condensed() changes the readings of some case.
bool has_dense_readings(const Corrected& experiment);

}  // namespace aspic
