#include "math/vectors.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/check.h"
#include "base/parallel.h"

namespace aspic {

double dot(std::span<const double> x, std::span<const double> y) {
  ASPIC_CHECK(x.size() == y.size());
  return parallel_sum(static_cast<int>(x.size()), [&](int first, int last) {
    double sum = 0;
    for (int i = first; i < last; ++i) sum += x[i] * y[i];
    return sum;
  });
}

double squared_norm(std::span<const double> x) { return dot(x, x); }
double norm(std::span<const double> x) { return std::sqrt(dot(x, x)); }

double max_abs(std::span<const double> x) {
  double largest = 0;
  for (const double xi : x) {
    if (std::isnan(xi)) return xi;
    largest = std::max(largest, std::abs(xi));
  }
  return largest;
}

void add_scaled(double s, std::span<const double> x, std::span<double> y) {
  ASPIC_CHECK(x.size() == y.size());
  for (size_t i = 0; i < x.size(); ++i) y[i] += s * x[i];
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

}  // namespace aspic
