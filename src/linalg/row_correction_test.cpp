#include "linalg/row_correction.h"

#include <gtest/gtest.h>

#include "linalg/conjugate_gradient.h"
#include "linalg/linear_solver.h"
#include "linalg/matrices_test.h"
#include "linalg/multigrid.h"
#include "math/vectors.h"

namespace aspic {
namespace {

using namespace test;

// Adds k c c' (x) n n' for coefficients c that sum to zero: a spring along n between points of two bodies.
void add_spring(const std::array<int, 4>& row, double k, const Vec3d& n, BlockSparse& H) {
  constexpr double c[] = {1, -0.5, -0.3, -0.2};
  Stencil stencil{.row = row};
  for (int i = 0, at = 0; i < 4; ++i)
    for (int j = 0; j <= i; ++j) {
      Mat3d K;
      for (int r = 0; r < 3; ++r)
        for (int s = 0; s < 3; ++s) K(r, s) = k * c[i] * c[j] * n[r] * n[s];
      if (i == j) {
        Mat3d& D = H.block[H.pattern->diagonal(row[i])];
        D = D + K;
      } else {
        stencil.block[at++] = K;
      }
    }
  H.stencils.push_back(stencil);
}

// A lattice with springs of stiffness k between vertices that its pattern does not couple.
Matrix lattice_in_contact(double k, int springs = 40) {
  Matrix H = spring_lattice({.nx = 10, .ny = 6, .nz = 6, .stiffness = 100});
  const std::vector<double> normals = random_vector(3 * 40, 7);
  for (int s = 0; s < springs; ++s) {
    const Vec3d n = vec_at(normals, s);
    const int a = 5 * s, b = H.rows() - 1 - 4 * s;
    add_spring({b, a, a + 1, a + 2}, k, (1 / norm(n)) * n, H.values);
  }
  return H;
}

TEST(Stencils, ProductMatchesDenseMatrix) {
  const Matrix H = lattice_in_contact(50);
  const std::vector<double> u = random_vector(3 * H.rows(), 1), v = random_vector(3 * H.rows(), 2);
  std::vector<double> Hu(u.size()), Hv(u.size()), Au(u.size());
  H.values.multiply(u, Hu);
  H.values.multiply(v, Hv);
  EXPECT_NEAR(dot(Hu, v), dot(Hv, u), 1e-10 * norm(Hu) * norm(v));
  BlockSparse A = H.values;
  A.stencils.clear();
  A.multiply(u, Au);
  double energy = 0;  // energy of the springs' off-diagonal blocks
  for (const Stencil& stencil : H.values.stencils)
    for (int i = 1, k = 0; i < 4; ++i)
      for (int j = 0; j < i; ++j, ++k)
        energy += 2 * dot(vec_at(u, stencil.row[i]), stencil.block[k] * vec_at(u, stencil.row[j]));
  EXPECT_NEAR(dot(Hu, u) - dot(Au, u), energy, 1e-10 * dot(Hu, u));
}

TEST(Stencils, EverySolverReachesTheTolerance) {
  const Matrix H = lattice_in_contact(1e6);
  const std::vector<double> b = random_vector(3 * H.rows(), 3);
  for (const std::string& name : linear_solver_names()) {
    const auto solver = make_linear_solver(name);
    solver->analyze(*H.pattern);
    solver->begin();
    ASSERT_TRUE(solver->factorize(H.values)) << name;
    std::vector<double> x(b.size());
    const SolveReport report = solver->solve(b, x, 1e-8);
    EXPECT_TRUE(report.ok) << name;
    EXPECT_LE(relative_residual(H.values, b, x), 1.01e-8) << name;
  }
}

TEST(RowCorrection, IterationsAreBoundedForAnyStiffness) {
  const auto iterations = [](double k) {
    const Matrix H = lattice_in_contact(k);
    ConjugateGradient solver(std::make_unique<Multigrid>());
    solver.analyze(*H.pattern);
    EXPECT_TRUE(solver.factorize(H.values));
    const std::vector<double> b = random_vector(3 * H.rows(), 3);
    std::vector<double> x(b.size());
    return solver.solve(b, x, 1e-4).iterations;
  };
  const int soft = iterations(1e-3);
  EXPECT_LE(iterations(1e4), 4 * soft);
  EXPECT_LE(iterations(1e8), 4 * soft);
}

TEST(RowCorrection, IsSymmetric) {
  const Matrix H = lattice_in_contact(1e4);
  BlockJacobi jacobi;
  jacobi.analyze(*H.pattern);
  ASSERT_TRUE(jacobi.factorize(H.values));
  RowCorrection correction;
  ASSERT_TRUE(correction.factorize(H.values));
  const std::vector<double> u = random_vector(3 * H.rows(), 1), v = random_vector(3 * H.rows(), 2);
  std::vector<double> Mu(u.size()), Mv(v.size());
  correction.apply(jacobi, u, Mu);
  correction.apply(jacobi, v, Mv);
  EXPECT_NEAR(dot(Mu, v), dot(Mv, u), 1e-10 * norm(Mu) * norm(v));
}

TEST(RowCorrection, LeavesOutWeakStencilsOnlyIfTheirFactorIsLarge) {
  const auto is_needed = [](double k, int springs) {
    const Matrix H = lattice_in_contact(k, springs);
    RowCorrection correction;
    EXPECT_TRUE(correction.factorize(H.values));
    return correction.is_needed();
  };
  EXPECT_TRUE(is_needed(1, 3));
  EXPECT_FALSE(is_needed(1, 40));
  EXPECT_TRUE(is_needed(1e4, 40));
}

TEST(RowCorrection, RejectsIndefiniteRows) {
  const Matrix H = lattice_in_contact(-1e6);
  EXPECT_FALSE(RowCorrection().factorize(H.values));
}

}  // namespace
}  // namespace aspic
