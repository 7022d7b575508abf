// How long a direction should be, for methods whose directions say only where to go.
#pragma once
#include <span>
#include <vector>

#include "optimize/search_direction.h"

namespace aspic {

// The minimizer along p of the quadratic with the slope and the curvature of E at x: -g.p / p'Hp. The curvature is a
// difference of gradients over a short way, which costs one gradient.
class ModelStep {
 public:
  void begin() { last_ = 0; }
  // Where there is no positive curvature: so long that the largest displacement is that of the last step, doubled (of
  // the first step: E.scales().x).
  double along(const Iterate& at, std::span<const double> p, DirectionReport& report);

 private:
  double last_ = 0;  // the largest entry of the last step; 0: there is none
  std::vector<double> ahead_, gradient_;
};

}  // namespace aspic
