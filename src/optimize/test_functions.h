// Functions with known minima for comparing methods.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "optimize/planar_function.h"

namespace aspic {

// f(x, y) = (1 - x)^2 + 100 (y - x^2)^2: minimum 0 at (1, 1), at the end of a curved valley [Rosenbrock 1960].
class Rosenbrock : public PlanarFunction {
 public:
  double at(const Planar& p) const override;
  Planar gradient_at(const Planar& p) const override;
  PlanarHessian hessian_at(const Planar& p) const override;
};

// f(x, y) = x exp(-x^2 - y^2): a dip with minimum -1/sqrt(2 e) at (-1/sqrt(2), 0) next to a bump; flat far away.
class TwoBump : public PlanarFunction {
 public:
  double at(const Planar& p) const override;
  Planar gradient_at(const Planar& p) const override;
  PlanarHessian hessian_at(const Planar& p) const override;
};

// f(p) = 1/2 p' R diag(1, condition) R' p: minimum 0 at the origin of a straight valley that is rotated by `angle`.
class Quadratic : public PlanarFunction {
 public:
  explicit Quadratic(double condition = 100, double angle = 0.5235987755982988 /* 30 degrees */);
  double at(const Planar& p) const override;
  Planar gradient_at(const Planar& p) const override;
  PlanarHessian hessian_at(const Planar&) const override { return H_; }

 private:
  PlanarHessian H_;
};

// Description of a test function.
struct TestFunction {
  std::string name, formula, remarks;
  Planar minimizer{};       // position of the minimum
  double minimum = 0;       // value there
  Planar start{};           // recommended initial guess
  Planar lower{}, upper{};  // region to plot
};
std::vector<TestFunction> test_functions();  // all, in the order of help texts
// Both throw InvalidInput for an unknown name.
TestFunction test_function_info(const std::string& name);
std::unique_ptr<PlanarFunction> make_test_function(const std::string& name);

}  // namespace aspic
