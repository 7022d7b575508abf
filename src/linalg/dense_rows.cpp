#include "linalg/dense_rows.h"

#include "math/vectors.h"

namespace aspic {

void add_product(const DenseRows& rows, std::span<const double> x, std::span<double> y) {
  for (const DenseRow& row : rows) {
    const double part = row.weight * dot(row.g, x);
    for (size_t i = 0; i < y.size(); ++i) y[i] += part * row.g[i];
  }
}

}  // namespace aspic
