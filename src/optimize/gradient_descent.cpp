#include "optimize/gradient_descent.h"

namespace aspic {

std::string GradientDescent::description() const { return "gradient_descent, preconditioner " + B_.description(); }

bool GradientDescent::compute(Objective& E, std::span<const double> x, std::span<const double> g,
                              const InnerAccuracy& accuracy, std::span<double> d, DirectionReport& report) {
  B_.set_deadline(accuracy.deadline);
  if (!B_.apply(E, x, g, d, report)) return false;
  for (double& di : d) di = -di;
  return true;
}

}  // namespace aspic
