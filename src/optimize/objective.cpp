#include "optimize/objective.h"

#include <cmath>

#include "base/parallel.h"

namespace aspic {

double Objective::dot(std::span<const double> a, std::span<const double> b) {
  return parallel_sum(static_cast<int>(a.size()), [&](int first, int last) {
    double sum = 0;
    for (int i = first; i < last; ++i) sum += a[i] * b[i];
    return sum;
  });
}

void WholePart::measure_parts(std::span<const double> g, std::span<GradientPart> parts) {
  parts[0] = {std::sqrt(E_.dot(g, g)), E_.scales().gradient};
}

double WholePart::relative_decrement(std::span<const double> g, std::span<const double> d) {
  return std::sqrt(-E_.dot(g, d) / 2 / E_.scales().value);
}

}  // namespace aspic
