// Prior and posterior variances of the fitted quantities in every tet.
#pragma once
#include <vector>

#include "fit/parameter_map.h"
#include "fit/spectrum.h"

namespace aspic {

struct MarginalOptions {
  int exact = 3000;   // maximum number of values with one solve each
  int samples = 256;  // otherwise: samples of the undetermined part
  unsigned seed = 2;
};

struct Marginals {
  std::vector<std::vector<double>> before, after;  // sigma of each parameter in each tet, on the fitted scale (log E)
  double relative_error = 0;                       // largest standard error of a standard deviation; 0: exact
};

Marginals marginals(PosteriorGaussian& gaussian, const ParameterMap& map, const MarginalOptions& options = {});

}  // namespace aspic
