#include "optimize/gradient_descent.h"

namespace aspic {

bool GradientDescent::compute(Objective&, std::span<const double>, std::span<const double> g, double,
                              std::span<double> d, DirectionReport&) {
  for (size_t i = 0; i < g.size(); ++i) d[i] = -g[i];
  return true;
}

}  // namespace aspic
