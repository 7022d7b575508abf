// Compares the derivatives of a function with central differences. The error decreases by 100 per decade of the step
// until round-off dominates; the error of a wrong derivative does not.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "optimize/objective.h"

namespace aspic {

struct Differentiable {
  std::function<double(std::span<const double> x)> value;
  std::function<void(std::span<const double> x, std::span<double> g)> gradient;
  std::function<void(std::span<const double> x, std::span<const double> d, std::span<double> Hd)> hessian_times;
};
Differentiable differentiable(Objective& E);  // refers to E; uses the exact Hessian

struct DerivativeCheckOptions {
  double length = 1;        // length unit of the steps: a displacement that changes the function considerably
  int directions = 3;       // number of random directions; the largest error is reported
  uint64_t seed = 7;        // seed of their entries, uniform in [-1, 1]
  double tolerance = 1e-6;  // bound of the smallest error
  double negligible = 0;    // products H d below this size are zero
  std::vector<char> fixed;  // marks entries of x that are constant; empty: none
};

// One derivative compared with difference quotients.
struct DerivativeCheck {
  std::vector<double> step, error;  // step relative to the length: 1e-1 ... 1e-9; error relative to the derivative
  double smallest_error = 0;
  double order = 0;  // fitted slope of log error over log step where the error decreases; NaN: only round-off
  bool passed = false;

  // Entry of the gradient or Hessian with the largest error, at the step with the smallest error.
  int row = -1, column = -1;       // column: -1 for a gradient, and for a Hessian that passed
  double found = 0, expected = 0;  // derivative at this entry, and its difference quotient
};

struct DerivativeReport {
  DerivativeCheck gradient;  // compared with differences of the value
  DerivativeCheck hessian;   // compared with differences of the gradient
  bool passed() const { return gradient.passed && hessian.passed; }
};

// Checks the derivatives at x, where f must be finite. Steps that leave the domain have the error NaN.
DerivativeReport check_derivatives(const Differentiable& f, std::span<const double> x,
                                   const DerivativeCheckOptions& options = {});

}  // namespace aspic
