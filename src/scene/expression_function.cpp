#include "scene/expression_function.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace aspic {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// Truncation grows like h^4, round-off like eps / h for first and eps / h^2 for second derivatives.
double first_step(double x) { return std::pow(kEpsilon, 1.0 / 5) * std::max(1.0, std::abs(x)); }
double second_step(double x) { return std::pow(kEpsilon, 1.0 / 6) * std::max(1.0, std::abs(x)); }

}  // namespace

ExpressionFunction::ExpressionFunction(const std::string& formula)
    : formula_(formula, ExpressionVariables::plane_position) {}

Planar ExpressionFunction::gradient_at(const Planar& p) const {
  Planar slope;
  for (size_t i = 0; i < 2; ++i) {
    const double h = first_step(p[i]);
    const auto beside = [&](double steps) {
      Planar q = p;
      q[i] += steps * h;
      return at(q);
    };
    slope[i] = (8 * (beside(1) - beside(-1)) - (beside(2) - beside(-2))) / (12 * h);
  }
  return slope;
}

PlanarHessian ExpressionFunction::hessian_at(const Planar& p) const {
  const Planar h = {second_step(p[0]), second_step(p[1])};
  const auto beside = [&](double i, double j) { return at({p[0] + i * h[0], p[1] + j * h[1]}); };
  const double f = at(p);
  // f(x, y) of order 2, for steps of one and of two h: their combination is of order 4.
  const auto mixed = [&](double n) {
    return (beside(n, n) - beside(n, -n) - beside(-n, n) + beside(-n, -n)) / (4 * n * n * h[0] * h[1]);
  };
  const auto second = [&](double one, double two, double step) {
    return (16 * (one - 2 * f) - (two - 2 * f)) / (12 * step * step);
  };
  return {.xx = second(beside(1, 0) + beside(-1, 0), beside(2, 0) + beside(-2, 0), h[0]),
          .xy = (4 * mixed(1) - mixed(2)) / 3,
          .yy = second(beside(0, 1) + beside(0, -1), beside(0, 2) + beside(0, -2), h[1])};
}

void ExpressionFunction::gradient(std::span<const double> x, std::span<double> g) {
  PlanarFunction::gradient(x, g);
  const double h = std::min(first_step(x[0]), first_step(x[1]));
  gradient_round_off_ = 2 * kEpsilon * std::abs(at({x[0], x[1]})) / h;
}

}  // namespace aspic
