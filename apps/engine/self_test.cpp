#include "engine/self_test.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "linalg/linear_solver.h"
#include "math/small.h"

namespace aspic::engine {
namespace {

// In place, as the vectorizer of straight-line code miscompiles it in emscripten 3.1.6.
__attribute__((noinline)) void transform(std::span<Vec3d> points, const double* A, const double* b) {
  for (Vec3d& p : points) {
    Vec3d image;
    for (int i = 0; i < 3; ++i) {
      double sum = 0;
      for (int j = 0; j < 3; ++j) sum += A[3 * i + j] * p[j];
      image[i] = sum + b[i];
    }
    p = image;
  }
}

bool transforms_points() {
  const double A[9] = {0, 0, 1, 0, 1, 0, -1, 0, 0}, b[3] = {1, 2, 4};
  std::vector<Vec3d> points;
  for (int i = 0; i < 5; ++i) points.push_back({{1.0 + i, 2.0 + i, 3.0 + i}});
  transform(points, A, b);
  for (int i = 0; i < 5; ++i)
    if (points[i][0] != 4 + i || points[i][1] != 4 + i || points[i][2] != 3 - i) return false;
  return true;
}

// A chain of springs in space, clamped by a mass: large enough for several supernodes.
bool solves(const std::string& solver_name) {
  constexpr int kRows = 300;
  Couplings couplings;
  for (int k = 1; k < kRows; ++k)
    for (const int to : {k - 1, k / 2}) couplings.emplace_back(k, to);
  const BlockPattern pattern = make_pattern(kRows, couplings);
  BlockSparse H(pattern);
  for (int r = 0; r < kRows; ++r)
    for (int64_t s = pattern.row_start[r]; s < pattern.row_start[r + 1]; ++s)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          const bool is_diagonal = s == pattern.diagonal(r);
          H.block[s](i, j) = (is_diagonal ? (i == j ? 30.0 : 1.0) : -0.3) / (is_diagonal ? 1 : 1 + i + 2 * j);
        }
  std::vector<double> expected(3 * kRows), b(3 * kRows), x(3 * kRows, 0.0);
  for (int i = 0; i < 3 * kRows; ++i) expected[i] = std::sin(0.1 * i);
  H.multiply(expected, b);
  const auto solver = make_linear_solver(solver_name);
  solver->analyze(pattern);
  if (!solver->factorize(H)) return false;
  solver->solve(b, x, 1e-12);
  double error = 0;
  for (int i = 0; i < 3 * kRows; ++i) error = std::max(error, std::abs(x[i] - expected[i]));
  return error < 1e-9;
}

}  // namespace

std::string self_test() {
  if (!transforms_points()) return "an affine map";
  for (const char* solver : {"cholesky", "block_jacobi"})
    if (!solves(solver)) return std::string("the linear solver ") + solver;
  return "";
}

}  // namespace aspic::engine
