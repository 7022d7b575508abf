#include "estimate/evidence.h"

#include <cmath>
#include <vector>

namespace aspic {
namespace {

// -2 log of the evidence with `factor` times the weight of the fit, up to a constant. Along direction k the data give
// the amplitude a = c (1 + d) / d, where the fit has c; a has the distribution N(0, 1 / factor + 1 / d).
double surprise(double factor, const Spectrum& s, std::span<const double> amplitudes) {
  double sum = 0;
  for (size_t k = 0; k < s.d.size(); ++k) {
    if (!(s.d[k] > 1e-6)) continue;
    const double a = amplitudes[k] * (1 + s.d[k]) / s.d[k], variance = 1 / factor + 1 / s.d[k];
    sum += a * a / variance + std::log(variance * s.d[k]);
  }
  return sum;
}

}  // namespace

SupportedWeight supported_weight(Regularizer& prior, double weight, std::span<const double> p, const Spectrum& s) {
  if (!(weight > 0) || s.d.empty()) return {};
  std::vector<double> g(p.size(), 0.0);
  prior.add_gradient(p, weight, g);
  const std::vector<double> amplitudes = product_transposed(s.W, g);
  constexpr double kRange = 14, kStep = 0.1;  // of log weight: a million times more or less, within 5 %
  const double now = surprise(1, s, amplitudes);
  SupportedWeight best;
  for (double x = -kRange; x <= kRange; x += kStep)
    if (const double gain = now - surprise(std::exp(x), s, amplitudes); gain > best.gain) best = {std::exp(x), gain};
  return best;
}

}  // namespace aspic
