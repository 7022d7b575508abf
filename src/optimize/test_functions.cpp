#include "optimize/test_functions.h"

#include <algorithm>
#include <cmath>

namespace aspic {
namespace {

// Raises the eigenvalues of the symmetric 2x2 matrix [[a, b], [b, c]] in place, or takes their absolute values.
void make_definite(double& a, double& b, double& c, Definiteness kind) {
  if (kind == Definiteness::exact) return;
  const double mean = (a + c) / 2, radius = std::hypot((a - c) / 2, b), angle = std::atan2(b, (a - c) / 2) / 2;
  double high = mean + radius, low = mean - radius;
  const double floor = 1e-8 * std::max(std::abs(high), std::abs(low));
  for (double* lambda : {&high, &low})
    *lambda = std::max(kind == Definiteness::absolute ? std::abs(*lambda) : *lambda, floor);
  const double n = std::cos(angle), m = std::sin(angle);
  a = high * n * n + low * m * m;
  b = (high - low) * n * m;
  c = high * m * m + low * n * n;
}

}  // namespace

Rosenbrock::Rosenbrock() : pattern_(make_pattern(1, {})), H_(pattern_) {}

double Rosenbrock::value(std::span<const double> x) {
  const double a = 1 - x[0], b = x[1] - x[0] * x[0];
  return a * a + 100 * b * b + x[2] * x[2] / 2;
}

void Rosenbrock::gradient(std::span<const double> x, std::span<double> g) {
  const double b = x[1] - x[0] * x[0];
  g[0] = -2 * (1 - x[0]) - 400 * x[0] * b;
  g[1] = 200 * b;
  g[2] = x[2];
}

const BlockSparse& Rosenbrock::hessian(std::span<const double> x, const Projection& projection) {
  double xx = 2 - 400 * (x[1] - 3 * x[0] * x[0]), xy = -400 * x[0], yy = 200;
  make_definite(xx, xy, yy, projection.kind);
  H_.block[0] = {{xx, xy, 0, xy, yy, 0, 0, 0, 1}};
  return H_;
}

}  // namespace aspic
