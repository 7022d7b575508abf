#include "optimize/planar_function.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace aspic {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// Clamps negative eigenvalues or takes their absolute values. Returns false if there are none.
bool modify_hessian(PlanarHessian& H, Definiteness kind) {
  const double mean = (H.xx + H.yy) / 2, radius = std::hypot((H.xx - H.yy) / 2, H.xy);
  double high = mean + radius, low = mean - radius;
  const double floor = 1e-8 * std::max(std::abs(high), std::abs(low));
  if (kind == Definiteness::exact || low >= floor) return false;
  const double angle = std::atan2(H.xy, (H.xx - H.yy) / 2) / 2;
  for (double* lambda : {&high, &low})
    *lambda = std::max(kind == Definiteness::absolute ? std::abs(*lambda) : *lambda, floor);
  const double c = std::cos(angle), s = std::sin(angle);
  H = {.xx = high * c * c + low * s * s, .xy = (high - low) * c * s, .yy = high * s * s + low * c * c};
  return true;
}

}  // namespace

double QuadraticModel::at(const Planar& p) const {
  const double u = p[0] - center[0], v = p[1] - center[1];
  return value + gradient[0] * u + gradient[1] * v +
         0.5 * (hessian.xx * u * u + 2 * hessian.xy * u * v + hessian.yy * v * v);
}

PlanarFunction::PlanarFunction() : pattern_(make_pattern(1, {})), H_(pattern_) {}

QuadraticModel PlanarFunction::model(const Planar& p, Definiteness kind) const {
  QuadraticModel model{.center = p, .value = at(p), .gradient = gradient_at(p), .hessian = hessian_at(p)};
  modify_hessian(model.hessian, kind);
  return model;
}

Evaluation PlanarFunction::evaluate(std::span<const double> x) {
  const double f = at({x[0], x[1]});
  return {f + x[2] * x[2] / 2, 4 * kEpsilon * std::abs(f)};
}

void PlanarFunction::gradient(std::span<const double> x, std::span<double> g) {
  const Planar slope = gradient_at({x[0], x[1]});
  g[0] = slope[0];
  g[1] = slope[1];
  g[2] = x[2];
}

const BlockSparse& PlanarFunction::evaluate_hessian(std::span<const double> x, const Projection& projection) {
  PlanarHessian H = hessian_at({x[0], x[1]});
  gradient_round_off_ = kEpsilon * std::hypot(x[0], x[1]) * std::hypot(H.xx, std::sqrt(2) * H.xy, H.yy);
  projected_elements_ = projection.covers(0) && modify_hessian(H, projection.kind);
  H_.block[0] = {{H.xx, H.xy, 0, H.xy, H.yy, 0, 0, 0, 1}};
  return H_;
}

}  // namespace aspic
