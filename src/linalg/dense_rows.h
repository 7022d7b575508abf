// Rank-one parts of a symmetric matrix that couple many rows: sum over rows of weight g g'. The sparse matrix A does
// not contain them.
#pragma once
#include <span>
#include <vector>

namespace aspic {

struct DenseRow {
  std::vector<double> g;  // 3 entries per block row of A
  double weight = 0;      // > 0
};
using DenseRows = std::vector<DenseRow>;

// y += sum over rows of weight g (g . x)
void add_product(const DenseRows& rows, std::span<const double> x, std::span<double> y);

}  // namespace aspic
