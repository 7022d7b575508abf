#include "energy/tet_integrals.h"

#include <algorithm>

#include "mesh/tet_nodes.h"

namespace aspic {
namespace {

TetIntegrals linear_integrals() {
  TetIntegrals table{};
  for (int n = 0; n < 4; ++n) {
    table.mean[n] = table.lumped[n] = 1;
    for (int m = 0; m < 4; ++m) table.products[n][m] = n == m ? 2 : 1;
  }
  table.mean_sum = table.lumped_sum = 4, table.products_sum = 20;
  return table;
}

// Number of corners that two nodes have in common; a mid-edge node has the two of its edge.
int common_corners(int n, int m) {
  const auto corners = [](int node) {
    return node < 4 ? std::array{node, node} : std::array{kTetEdges[node - 4][0], kTetEdges[node - 4][1]};
  };
  const std::array<int, 2> a = corners(n), b = corners(m);
  if (n == m) return 2;
  return std::any_of(a.begin(), a.end(), [&](int corner) { return corner == b[0] || corner == b[1]; }) ? 1 : 0;
}

TetIntegrals quadratic_integrals() {
  TetIntegrals table{};
  const auto is_corner = [](int n) { return n < 4; };
  for (int n = 0; n < 10; ++n) {
    table.mean[n] = is_corner(n) ? -1 : 4;
    table.lumped[n] = is_corner(n) ? 3 : 16;
    for (int m = 0; m < 10; ++m) {
      const int common = common_corners(n, m);
      int& product = table.products[n][m];
      if (is_corner(n) && is_corner(m))
        product = n == m ? 6 : 1;
      else if (is_corner(n) || is_corner(m))
        product = common > 0 ? -4 : -6;
      else
        product = common == 2 ? 32 : common == 1 ? 16 : 8;
    }
  }
  table.mean_sum = 20, table.products_sum = 420, table.lumped_sum = 108;
  return table;
}

}  // namespace

const TetIntegrals& tet_integrals(int nodes) {
  static const TetIntegrals linear = linear_integrals(), quadratic = quadratic_integrals();
  return nodes == 4 ? linear : quadratic;
}

}  // namespace aspic
