// From a field to the parts that it is made of: a few values, and the places where they hold.
#pragma once
#include <span>
#include <vector>

#include "fit/least_squares.h"
#include "fit/parameter_map.h"
#include "fit/parts_sampler.h"

namespace aspic {

struct Parts {
  bool ok = false;  // false: an equilibrium was not found, or the field gathers about fewer values
  PartsEstimate estimate;
  std::vector<double> p;  // of the field's map, with `estimate.mean`
  double squares = 0;     // |r|^2 there
};

// `count` parts of `unknown`, which is one per tet, beginning where the field p gathers. Each pass linearizes the model
// at the mean of the samples of the one before; by what the last one still moved, deviations are larger.
Parts find_parts(LeastSquares& model, const ParameterMap& map, const TetMesh& mesh, std::span<const double> p,
                 int unknown, int count, const PartsOptions& options = {});

// Whether parts explain the measurements about as well as the field, of |r|^2 = `field_squares`, or the noise does.
bool are_as_good(const Parts& parts, double field_squares, int residuals);

}  // namespace aspic
