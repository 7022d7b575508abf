// Variances of the fitted quantities in every tet, before and after the data.
#pragma once
#include <vector>

#include "fit/parameter_map.h"
#include "fit/spectrum.h"

namespace aspic {

struct MarginalOptions {
  int exact = 3000;   // largest number of values with one solve each
  int samples = 256;  // else: of what the data do not see
  unsigned seed = 2;
};

struct Marginals {
  std::vector<std::vector<double>> before, after;  // of each unknown in each tet, as it is fitted (log E)
  double relative_error = 0;                       // largest standard error of a standard deviation; 0: they are exact
};

Marginals marginals(PosteriorGaussian& belief, const ParameterMap& map, const MarginalOptions& options = {});

}  // namespace aspic
