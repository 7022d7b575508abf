// d = -g
#pragma once
#include "optimize/search_direction.h"

namespace aspic {

class GradientDescent : public SearchDirection {
 public:
  std::string_view name() const override { return "gradient_descent"; }
  bool compute(Objective& E, std::span<const double> x, std::span<const double> g, double forcing, std::span<double> d,
               DirectionReport& report) override;
};

}  // namespace aspic
