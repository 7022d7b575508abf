// "Gradient of what equals this?": central differences of a term against its own derivatives.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "energy/energy.h"

namespace aspic::testing_derivatives {

struct Errors {
  double gradient = 0, hessian = 0;  // relative to the largest entry of the exact directional derivative
};

// Along the direction d, with differences of width e.
inline Errors difference_errors(const Energy& V, const BlockPattern& pattern, const std::vector<double>& x,
                                const std::vector<double>& d, double e) {
  const size_t n = x.size();
  std::vector<double> ahead = x, behind = x, g(n), g_ahead(n), g_behind(n), Hd(n);
  for (size_t i = 0; i < n; ++i) ahead[i] += e * d[i], behind[i] -= e * d[i];
  V.add_gradient(x, 1, g);
  V.add_gradient(ahead, 1, g_ahead);
  V.add_gradient(behind, 1, g_behind);
  BlockSparse H(pattern);
  V.add_hessian(x, 1, {Definiteness::exact}, H);
  H.multiply(d, Hd);
  double slope = 0, scale = 0, largest = 0, worst = 0;
  for (size_t i = 0; i < n; ++i) {
    slope += g[i] * d[i];
    scale += std::abs(g[i] * d[i]);
    largest = std::max(largest, std::abs(Hd[i]));
    worst = std::max(worst, std::abs((g_ahead[i] - g_behind[i]) / (2 * e) - Hd[i]));
  }
  const double difference = (V.value(ahead) - V.value(behind)) / (2 * e);
  return {scale > 0 ? std::abs(difference - slope) / scale : std::abs(difference),
          largest > 0 ? worst / largest : worst};
}

// The systems of single vertices are parts of the whole gradient and Hessian, up to the order of summation.
inline void expect_vertex_systems_to_be_parts(Energy& V, const BlockPattern& pattern, const std::vector<double>& x,
                                              const std::string& what) {
  constexpr double kRoundOff = 1e-13;  // of sums of some hundred terms
  const int vertices = pattern.rows();
  ASSERT_TRUE(V.prepare_vertex_systems(vertices)) << what;
  std::vector<double> whole(x.size());
  V.add_gradient(x, 2, whole);
  BlockSparse H(pattern);
  V.add_hessian(x, 2, {Definiteness::exact}, H);
  std::vector<int> all(vertices);
  std::iota(all.begin(), all.end(), 0);
  std::vector<Vec3d> g(vertices, Vec3d{});
  std::vector<Mat3d> blocks(vertices, Mat3d{});
  V.add_vertex_systems(x, 2, all, g, blocks);
  double largest_force = 0, largest_entry = 0;
  for (const double gi : whole) largest_force = std::max(largest_force, std::abs(gi));
  for (const Mat3d& block : H.block) largest_entry = std::max(largest_entry, std::sqrt(squared_norm(block)));
  for (int v = 0; v < vertices; ++v) {
    for (int r = 0; r < 3; ++r) EXPECT_NEAR(g[v][r], whole[3 * v + r], kRoundOff * largest_force) << what;
    const Mat3d difference = blocks[v] - H.block[pattern.diagonal(v)];
    EXPECT_LE(std::sqrt(squared_norm(difference)), kRoundOff * largest_entry) << what;
  }
}

// The error of central differences falls by 100 when their width falls by 10, until round-off takes over; a wrong
// derivative leaves an error that does not fall.
inline void expect_consistent(Energy& V, int vertices, const std::vector<double>& x, double width,
                              const std::string& what) {
  Couplings couplings;
  V.add_couplings(couplings);
  const BlockPattern pattern = make_pattern(vertices, couplings);
  V.bind(pattern);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<double> d(x.size());
  for (double& di : d) di = uniform(random);
  const Errors coarse = difference_errors(V, pattern, x, d, width);
  const Errors fine = difference_errors(V, pattern, x, d, width / 10);
  EXPECT_LT(fine.gradient, std::max(coarse.gradient / 50, 1e-8)) << what << ", gradient; coarse " << coarse.gradient;
  EXPECT_LT(fine.hessian, std::max(coarse.hessian / 50, 1e-7)) << what << ", Hessian; coarse " << coarse.hessian;
  EXPECT_LT(fine.gradient, 1e-4) << what;
  EXPECT_LT(fine.hessian, 1e-4) << what;
  expect_vertex_systems_to_be_parts(V, pattern, x, what);
}

}  // namespace aspic::testing_derivatives
