// Divides a field into parts: a few values and their locations.
#pragma once
#include <span>
#include <vector>

#include "fit/least_squares.h"
#include "fit/parameter_map.h"
#include "fit/parts_sampler.h"

namespace aspic {

struct Parts {
  bool ok = false;  // false: no equilibrium, or the field clusters at fewer values
  PartsEstimate estimate;
  std::vector<double> p;  // for the field's map, with `estimate.mean`
  double squares = 0;     // |r|^2 there
};

// Finds `count` parts of `parameter`, a value per tet, starting from the clusters of the field p. Each pass linearizes
// the model at the mean of the previous samples; the change of the last pass increases the standard deviations.
Parts find_parts(LeastSquares& model, const FittedField& field, int unknown, int count,
                 const PartsOptions& options = {});

// Whether the parts fit the measurements about as well as the field, with |r|^2 = `field_squares`, or within the noise.
bool are_as_good(const Parts& parts, double field_squares, int residuals);

}  // namespace aspic
