#include "optimize/test_functions.h"

#include <cmath>

#include "base/error.h"

namespace aspic {

double Rosenbrock::at(const Planar& p) const {
  const double a = 1 - p[0], b = p[1] - p[0] * p[0];
  return a * a + 100 * b * b;
}

Planar Rosenbrock::gradient_at(const Planar& p) const {
  const double b = p[1] - p[0] * p[0];
  return {-2 * (1 - p[0]) - 400 * p[0] * b, 200 * b};
}

PlanarHessian Rosenbrock::hessian_at(const Planar& p) const {
  return {.xx = 2 - 400 * (p[1] - 3 * p[0] * p[0]), .xy = -400 * p[0], .yy = 200};
}

double TwoBump::at(const Planar& p) const { return p[0] * std::exp(-p[0] * p[0] - p[1] * p[1]); }

Planar TwoBump::gradient_at(const Planar& p) const {
  const auto [x, y] = p;
  const double e = std::exp(-x * x - y * y);
  return {(1 - 2 * x * x) * e, -2 * x * y * e};
}

PlanarHessian TwoBump::hessian_at(const Planar& p) const {
  const auto [x, y] = p;
  const double e = std::exp(-x * x - y * y);
  return {.xx = (4 * x * x - 6) * x * e, .xy = -2 * y * (1 - 2 * x * x) * e, .yy = (4 * y * y - 2) * x * e};
}

Quadratic::Quadratic(double condition, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  H_ = {.xx = c * c + condition * s * s, .xy = (1 - condition) * c * s, .yy = s * s + condition * c * c};
}

double Quadratic::at(const Planar& p) const {
  return 0.5 * (H_.xx * p[0] * p[0] + 2 * H_.xy * p[0] * p[1] + H_.yy * p[1] * p[1]);
}

Planar Quadratic::gradient_at(const Planar& p) const {
  return {H_.xx * p[0] + H_.xy * p[1], H_.xy * p[0] + H_.yy * p[1]};
}

std::vector<TestFunction> test_functions() {
  return {{.name = "rosenbrock",
           .formula = "(1 - x)^2 + 100 (y - x^2)^2",
           .remarks = "a curved valley: gradient descent zig-zags, Newton's method without a line search overshoots",
           .minimizer = {1, 1},
           .minimum = 0,
           .start = {-0.8, 0.6},
           .lower = {-1.5, -1},
           .upper = {1.5, 2}},
          {.name = "two_bump",
           .formula = "x exp(-x^2 - y^2)",
           .remarks = "a dip beside a bump: indefinite away from the dip, flat far away",
           .minimizer = {-std::sqrt(0.5), 0},
           .minimum = -std::exp(-0.5) * std::sqrt(0.5),
           .start = {-0.4, 0.3},
           .lower = {-2, -2},
           .upper = {2, 2}},
          {.name = "quadratic",
           .formula = "1/2 p' R diag(1, 100) R' p, rotated by 30 degrees",
           .remarks = "a straight valley of condition 100: one Newton iteration, hundreds of gradient descent",
           .minimizer = {0, 0},
           .minimum = 0,
           .start = {1.2, 0.9},
           .lower = {-1.5, -1.5},
           .upper = {1.5, 1.5}}};
}

TestFunction test_function_info(const std::string& name) {
  std::vector<std::string> names;
  for (TestFunction& f : test_functions()) {
    if (f.name == name) return f;
    names.push_back(f.name);
  }
  throw InvalidInput("there is no function '" + name + "'" + suggestion(name, names));
}

std::unique_ptr<PlanarFunction> make_test_function(const std::string& name) {
  const TestFunction info = test_function_info(name);
  if (info.name == "rosenbrock") return std::make_unique<Rosenbrock>();
  if (info.name == "two_bump") return std::make_unique<TwoBump>();
  return std::make_unique<Quadratic>();
}

}  // namespace aspic
