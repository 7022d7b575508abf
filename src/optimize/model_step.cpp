#include "optimize/model_step.h"

#include <algorithm>
#include <cmath>

#include "math/vectors.h"

namespace aspic {
namespace {

// Width of the difference quotient relative to the size of x: about the square root of the machine epsilon, which
// balances truncation and round-off errors.
constexpr double kWidth = 1.5e-8;

}  // namespace

double ModelStep::along(const Iterate& at, std::span<const double> p, DirectionReport& report) {
  const auto& [E, x, g, accuracy, stop] = at;
  const double size = max_abs(p);
  if (!(size > 0) || !std::isfinite(size)) return 0;
  for (auto* v : {&ahead_, &gradient_}) v->resize(x.size());
  const double width = kWidth * std::max(1e-3 * E.scales().x, max_abs(x)) / size;
  for (size_t i = 0; i < x.size(); ++i) ahead_[i] = x[i] + width * p[i];
  E.gradient(ahead_, gradient_);
  ++report.gradients;
  for (size_t i = 0; i < x.size(); ++i) gradient_[i] -= g[i];
  const double curvature = E.dot(gradient_, p) / width;
  const double step = -E.dot(g, p) / curvature;
  const double chosen = curvature > 0 && std::isfinite(step) ? step : (last_ > 0 ? 2 * last_ : E.scales().x) / size;
  last_ = chosen * size;
  return chosen;
}

}  // namespace aspic
