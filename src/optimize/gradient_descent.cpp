#include "optimize/gradient_descent.h"

namespace aspic {

std::string GradientDescent::description() const { return "gradient_descent, preconditioner " + B_.description(); }

bool GradientDescent::compute(const Iterate& at, std::span<double> d, DirectionReport& report) {
  B_.set_stop(at.stop);
  if (!B_.apply(at.E, at.x, at.g, d, report)) return false;
  for (double& di : d) di = -di;
  return true;
}

}  // namespace aspic
