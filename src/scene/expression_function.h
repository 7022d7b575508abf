// A formula of x and y as a function to be minimized.
#pragma once
#include "optimize/planar_function.h"
#include "scene/expression.h"

namespace aspic {

// The derivatives are central differences of order 4, with steps that balance truncation and round-off. For a smooth
// function of values and lengths of order 1, the error of the gradient is about 1e-12 and that of the Hessian about
// 1e-9; tolerances below 1e-10 cannot be reached. Where the formula is undefined, value and derivatives are infinite or
// NaN.
class ExpressionFunction : public PlanarFunction {
 public:
  explicit ExpressionFunction(const std::string& formula);  // throws InvalidInput

  double at(const Planar& p) const override { return formula_.evaluate({{p[0], p[1], 0}}); }
  Planar gradient_at(const Planar& p) const override;
  PlanarHessian hessian_at(const Planar& p) const override;
  ObjectiveScales scales() const override { return {.gradient_round_off = gradient_round_off_}; }
  void gradient(std::span<const double> x, std::span<double> g) override;

 private:
  Expression formula_;
  double gradient_round_off_ = 0;
};

}  // namespace aspic
