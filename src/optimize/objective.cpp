#include "optimize/objective.h"

#include "base/parallel.h"

namespace aspic {

double Objective::dot(std::span<const double> a, std::span<const double> b) {
  return parallel_sum(static_cast<int>(a.size()), [&](int first, int last) {
    double sum = 0;
    for (int i = first; i < last; ++i) sum += a[i] * b[i];
    return sum;
  });
}

}  // namespace aspic
