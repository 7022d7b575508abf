// Principal components of the posterior as fields over the body, with tets weighted by volume.
#pragma once
#include <span>
#include <vector>

#include "estimate/spectrum.h"
#include "model/parameter_map.h"

namespace aspic {

struct PrincipalDirection {
  double prior = 0, posterior = 0;  // variances of the amplitude; mean over the body
  std::vector<double> p;            // change of p with the amplitude
};

// The `count` largest components, descending by `posterior`.
std::vector<PrincipalDirection> principal_directions(PosteriorGaussian& gaussian, const ParameterMap& map,
                                                     const TetMesh& mesh, int count);

// Root mean square over the body of all fitted quantities for p.
double root_mean_square(const ParameterMap& map, const TetMesh& mesh, std::span<const double> p);

}  // namespace aspic
