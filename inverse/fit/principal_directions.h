// In which fields over the body the uncertainty lies: principal components of the posterior, with tets weighted by
// their part of the volume.
#pragma once
#include <span>
#include <vector>

#include "fit/parameter_map.h"
#include "fit/spectrum.h"

namespace aspic {

struct PrincipalDirection {
  double before = 0, after = 0;  // variance of its amplitude, before and after the data; mean over the body
  std::vector<double> p;         // what moves along when the amplitude does
};

// The `count` largest, descending by `after`.
std::vector<PrincipalDirection> principal_directions(PosteriorGaussian& belief, const ParameterMap& map,
                                                     const TetMesh& mesh, int count);

// sqrt of the mean over the body of the squares of all fitted quantities that belong to p.
double root_mean_square(const ParameterMap& map, const TetMesh& mesh, std::span<const double> p);

}  // namespace aspic
