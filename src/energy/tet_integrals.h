// Integrals of the shape functions N_n of linear and quadratic tets, as integer parts of density times volume.
#pragma once
#include <array>

namespace aspic {

struct TetIntegrals {
  std::array<int, 10> mean;                      // int N_n = volume mean[n] / mean_sum
  std::array<std::array<int, 10>, 10> products;  // int N_n N_m = volume products[n][m] / products_sum
  std::array<int, 10> lumped;                    // positive: the diagonal of the products, scaled to the volume
  int mean_sum, products_sum, lumped_sum;
};

// `nodes`: 4 or 10. Lumping: Hinton, Rock and Zienkiewicz 1976; row sums of quadratic tets are negative at corners.
const TetIntegrals& tet_integrals(int nodes);

}  // namespace aspic
