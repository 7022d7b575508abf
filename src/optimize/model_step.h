// Step length from the quadratic model, for methods whose directions have no natural length.
#pragma once
#include <span>
#include <vector>

#include "optimize/search_direction.h"

namespace aspic {

// Minimizes the quadratic model of E along p: alpha = -g.p / p'Hp. The curvature p'Hp is a difference quotient, which
// costs one gradient.
class ModelStep {
 public:
  void begin() { last_ = 0; }
  // Returns the step length. Without positive curvature, the largest displacement is twice that of the last step, or
  // E.scales().x in the first step.
  double along(const Iterate& at, std::span<const double> p, DirectionReport& report);

 private:
  double last_ = 0;  // largest entry of the last step; 0: none
  std::vector<double> ahead_, gradient_;
};

}  // namespace aspic
