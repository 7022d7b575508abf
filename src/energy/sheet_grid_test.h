// A rectangular sheet of triangles, for tests of terms that act on sheets.
#pragma once
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <functional>
#include <random>
#include <vector>

#include "base/parallel.h"
#include "dynamics/step_derivatives.h"
#include "energy/energy.h"
#include "mesh/tet_mesh.h"

namespace aspic {

struct SheetGrid {
  std::vector<Vec3d> rest;
  std::vector<Triangle> triangles;

  int vertex_count() const { return static_cast<int>(rest.size()); }
  bool is_inner(int v, int nx, int ny) const {
    const int i = v % (nx + 1), j = v / (nx + 1);
    return 0 < i && i < nx && 0 < j && j < ny;
  }
};

// Returns nx x ny squares in the plane z = 0, each divided into two right-angled triangles. `jitter`: maximum
// displacement of the vertices, relative to the edge.
inline SheetGrid sheet_grid(int nx, int ny, double edge, double jitter = 0) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> noise(-jitter * edge, jitter * edge);
  SheetGrid grid;
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) {
      const double dx = noise(random), dy = noise(random);
      grid.rest.push_back({{i * edge + dx, j * edge + dy, 0}});
    }
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const int a = i + j * (nx + 1), b = a + 1, c = b + nx + 1, d = a + nx + 1;
      grid.triangles.push_back({a, b, c});
      grid.triangles.push_back({a, c, d});
    }
  return grid;
}

inline std::vector<double> flattened(const std::vector<Vec3d>& points) {
  std::vector<double> x;
  for (const Vec3d& p : points) x.insert(x.end(), {p[0], p[1], p[2]});
  return x;
}

// Returns the positions after random displacements of at most `amount`.
inline std::vector<double> shaken_sheet(const SheetGrid& grid, double amount, unsigned seed = 3) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-amount, amount);
  std::vector<double> x = flattened(grid.rest);
  for (double& xi : x) xi += uniform(random);
  return x;
}

// Returns the positions after a rotation and a translation.
inline std::vector<double> moved_rigidly(const std::vector<double>& x) {
  const Mat3d Q = {{0.36, 0.48, -0.8, -0.8, 0.6, 0, 0.48, 0.64, 0.6}};
  std::vector<double> y(x.size());
  for (size_t i = 0; i < x.size(); i += 3) {
    const Vec3d p = Q * Vec3d{{x[i], x[i + 1], x[i + 2]}};
    for (size_t r = 0; r < 3; ++r) y[i + r] = p[static_cast<int>(r)] + 2.0 - static_cast<double>(r);
  }
  return y;
}

inline BlockPattern sheet_pattern(Energy& V, int rows) {
  Couplings couplings;
  V.add_couplings(couplings);
  const BlockPattern pattern = make_pattern(rows, couplings);
  V.bind(pattern);
  return pattern;
}

inline void expect_sheet_derivatives(Energy& V, const std::vector<double>& x, double length,
                                     const StepContext& step = {}) {
  const BlockPattern pattern = sheet_pattern(V, static_cast<int>(x.size() / 3));
  const DerivativeReport report =
      check_derivatives(differentiable(ActiveTerm(V, step), pattern), x, {.length = length, .tolerance = 1e-7});
  EXPECT_TRUE(report.gradient.passed) << report.gradient.smallest_error << " at " << entry_name(report.gradient.row);
  EXPECT_TRUE(report.hessian.passed) << report.hessian.smallest_error << " at " << entry_name(report.hessian.row);
}

inline std::vector<double> gradient_of(const Energy& V, const std::vector<double>& x, const StepContext& step = {}) {
  std::vector<double> g(x.size());
  ActiveTerm(V, step).add_gradient(x, 1, g);
  return g;
}

struct DenseHessian {
  Eigen::MatrixXd H;
  int modified;  // elements

  Eigen::VectorXd eigenvalues() const { return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(H).eigenvalues(); }
};

inline DenseHessian dense_hessian(Energy& V, const std::vector<double>& x, Definiteness kind,
                                  const StepContext& step = {}) {
  const BlockPattern pattern = sheet_pattern(V, static_cast<int>(x.size() / 3));
  BlockSparse H(pattern);
  DenseHessian dense{Eigen::MatrixXd(x.size(), x.size()), ActiveTerm(V, step).add_hessian(x, 1, {kind}, H)};
  std::vector<double> e(x.size(), 0.0), column(x.size());
  for (size_t j = 0; j < x.size(); ++j) {
    e[j] = 1;
    H.multiply(e, column);
    e[j] = 0;
    dense.H.col(static_cast<Eigen::Index>(j)) =
        Eigen::Map<Eigen::VectorXd>(column.data(), static_cast<Eigen::Index>(column.size()));
  }
  return dense;
}

// Expects equal values, gradients and clamped Hessians for one and four threads.
inline void expect_equal_bits_for_threads(Energy& V, const std::vector<double>& x, const StepContext& step = {}) {
  const BlockPattern pattern = sheet_pattern(V, static_cast<int>(x.size() / 3));
  const int before = thread_count();
  std::vector<std::vector<double>> results;
  for (const int threads : {1, 4}) {
    set_thread_count(threads);
    const ActiveTerm term(V, step);
    std::vector<double> result(x.size());
    term.add_gradient(x, 1, result);
    result.push_back(term.value(x));
    BlockSparse H(pattern);
    result.push_back(term.add_hessian(x, 1, {Definiteness::clamped}, H));
    for (const Mat3d& block : H.block) result.insert(result.end(), block.a, block.a + 9);
    results.push_back(std::move(result));
  }
  set_thread_count(before);
  EXPECT_EQ(results[0], results[1]);
}

}  // namespace aspic
