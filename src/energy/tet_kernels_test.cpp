// Compares the vectorized kernels with a plain evaluation of the material formulas, tet by tet.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/parallel.h"
#include "energy/tet_elasticity.h"
#include "material/list.h"
#include "math/definite.h"
#include "mesh/generators.h"

namespace aspic {
namespace {

struct PlainSums {
  double value = 0;
  std::vector<double> gradient;
  BlockSparse hessian;
};

Vec3d position(const std::vector<double>& x, int v) { return {{x[3 * v], x[3 * v + 1], x[3 * v + 2]}}; }

Mat3d edges(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  return from_columns(b - a, c - a, d - a);
}

template <class M>
PlainSums plain_sums(const TetMesh& mesh, const std::vector<MaterialParameters>& parameters,
                     const std::vector<double>& x, Definiteness definiteness, const BlockPattern& pattern) {
  PlainSums sums{0, std::vector<double>(x.size(), 0.0), BlockSparse(pattern)};
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const auto [i, j, k, l] = mesh.tets[t];
    const auto& X = mesh.rest;
    const Mat3d B = inverse(edges(X[i], X[j], X[k], X[l]));
    const Mat3d F = edges(position(x, i), position(x, j), position(x, k), position(x, l)) * B;
    const auto p = M::params(parameters[t]);
    sums.value += volume(mesh, t) * M::psi(F, p);
    const Mat3d P = M::pk1(F, p);
    Mat9d A = M::hessian(F, p);
    if (definiteness == Definiteness::clamped) modify_hessian(A, EigenvalueFilter::clamp);
    if (definiteness == Definiteness::absolute) modify_hessian(A, EigenvalueFilter::absolute);
    // F depends on the corners as dF/dx_v = e_r b_v'.
    Vec3d b[4] = {};
    for (int v = 1; v < 4; ++v) {
      for (int c = 0; c < 3; ++c) b[v][c] = B(v - 1, c);
      b[0] = b[0] - b[v];
    }
    for (int u = 0; u < 4; ++u) {
      const Vec3d f = volume(mesh, t) * (P * b[u]);
      for (int r = 0; r < 3; ++r) sums.gradient[3 * mesh.tets[t][u] + r] += f[r];
      for (int v = 0; v < 4; ++v) {
        const int row = mesh.tets[t][u], column = mesh.tets[t][v];
        if (row < column) continue;
        Mat3d& block = sums.hessian.block[pattern.slot(row, column)];
        for (int r = 0; r < 9; ++r)
          for (int c = 0; c < 9; ++c) block(r % 3, c % 3) += volume(mesh, t) * b[u][r / 3] * A(r, c) * b[v][c / 3];
      }
    }
  }
  return sums;
}

// The number of tets is no multiple of the lanes, so that there is padding. The axes are stretched differently.
TetMesh make_mesh(int cells) { return make_box({{0, 0, 0}}, {{1, 0.7, 1.3}}, {cells, 3, 1}); }

// Returns rotated and perturbed positions; `amount` is relative to the edges.
std::vector<double> moved(const TetMesh& mesh, double amount, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-amount, amount);
  const Mat3d A = {{0.6, 0.9, 0.1, -0.8, 0.5, -0.2, 0.1, 0.2, 1.1}};
  std::vector<double> x;
  for (const Vec3d& X : mesh.rest) {
    const Vec3d y = A * X;
    for (int r = 0; r < 3; ++r) x.push_back(y[r] + 0.3 * uniform(random));
  }
  return x;
}

std::vector<MaterialParameters> heterogeneous(const TetMesh& mesh, const MaterialInfo& info) {
  std::vector<MaterialParameters> parameters;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    MaterialParameters p{lame_from_young_poisson(1 + 0.1 * t, 0.1 + 0.003 * t), {}};
    for (size_t k = 0; k < info.extra.size(); ++k) p.extra[k] = info.extra[k].fallback;
    parameters.push_back(p);
  }
  return parameters;
}

template <class M>
void expect_kernels_to_match(const TetMesh& mesh, const std::vector<double>& x, Definiteness definiteness,
                             double tolerance) {
  const std::string what = M::info().name;
  const auto parameters = heterogeneous(mesh, M::info());
  const auto V = make_tet_elasticity(what, mesh, 0, parameters);
  Couplings couplings;
  V->add_couplings(couplings);
  const BlockPattern pattern = make_pattern(mesh.vertex_count(), couplings);
  V->bind(pattern);
  const PlainSums plain = plain_sums<M>(mesh, parameters, x, definiteness, pattern);
  ASSERT_TRUE(std::isfinite(plain.value)) << what;

  EXPECT_NEAR(V->value(x), plain.value, tolerance * std::abs(plain.value)) << what;
  std::vector<double> g(x.size(), 0.0);
  V->add_gradient(x, 1, g);
  double largest_force = 0, force_error = 0;
  for (size_t i = 0; i < g.size(); ++i) {
    largest_force = std::max(largest_force, std::abs(plain.gradient[i]));
    force_error = std::max(force_error, std::abs(g[i] - plain.gradient[i]));
  }
  EXPECT_LE(force_error, tolerance * largest_force) << what;
  BlockSparse H(pattern);
  V->add_hessian(x, 1, {definiteness}, H);
  double largest_block = 0, block_error = 0;
  for (size_t s = 0; s < H.block.size(); ++s) {
    largest_block = std::max(largest_block, std::sqrt(squared_norm(plain.hessian.block[s])));
    block_error = std::max(block_error, std::sqrt(squared_norm(H.block[s] - plain.hessian.block[s])));
  }
  EXPECT_LE(block_error, tolerance * largest_block) << what << ", " << static_cast<int>(definiteness);
}

TEST(TetKernels, MatchFormulasForAnyNumberOfTets) {
  for (int tets = 1; tets <= 2 * kPackWidth + 1; ++tets) {
    TetMesh mesh = make_mesh(1);
    mesh.tets.resize(tets);
    const std::vector<double> x = moved(mesh, 0.1, tets);
    for_each_material([&]<class M>() { expect_kernels_to_match<M>(mesh, x, Definiteness::exact, 1e-12); });
  }
}

TEST(TetKernels, MatchFormulasAcrossBatchesAndGroups) {
  const TetMesh mesh = make_mesh(20);  // 360 tets
  for_each_material(
      [&]<class M>() { expect_kernels_to_match<M>(mesh, moved(mesh, 0.02, 1), Definiteness::exact, 1e-12); });
}

TEST(TetKernels, MatchFormulasForInvertedTets) {
  const TetMesh mesh = make_mesh(4);
  const std::vector<double> x = moved(mesh, 1.5, 1);
  EXPECT_LT(
      make_tet_elasticity("neo_hookean", mesh, 0, heterogeneous(mesh, material_info("neo_hookean")))->min_det_F(x),
      -0.1);
  for_each_material([&]<class M>() {
    if (!M::info().barrier) expect_kernels_to_match<M>(mesh, x, Definiteness::exact, 1e-11);
  });
}

TEST(TetKernels, AgreeWithFilteredFormulas) {
  const TetMesh mesh = make_mesh(4);
  for_each_material([&]<class M>() {
    const std::vector<double> x = moved(mesh, M::info().barrier ? 0.1 : 1.5, 1);
    for (const Definiteness definiteness : {Definiteness::clamped, Definiteness::absolute})
      expect_kernels_to_match<M>(mesh, x, definiteness, 1e-11);
  });
}

struct Sums {
  double value = 0;
  std::vector<double> gradient, hessian;
};

Sums sums_with_threads(int threads, const TetMesh& mesh, const std::vector<double>& x) {
  const int before = thread_count();
  set_thread_count(threads);
  const auto V = make_tet_elasticity("neo_hookean", mesh, 0, heterogeneous(mesh, material_info("neo_hookean")));
  Couplings couplings;
  V->add_couplings(couplings);
  const BlockPattern pattern = make_pattern(mesh.vertex_count(), couplings);
  V->bind(pattern);
  BlockSparse H(pattern);
  V->add_hessian(x, 1, {Definiteness::clamped}, H);
  Sums sums{V->value(x), std::vector<double>(x.size(), 0.0), {}};
  V->add_gradient(x, 1, sums.gradient);
  for (const Mat3d& block : H.block) sums.hessian.insert(sums.hessian.end(), block.a, block.a + 9);
  set_thread_count(before);
  return sums;
}

TEST(TetKernels, AreBitReproducibleForAnyThreadCount) {
  const TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {12, 9, 7});  // 36 groups
  const std::vector<double> x = moved(mesh, 0.1, 3);
  const Sums alone = sums_with_threads(1, mesh, x);
  for (const int threads : {2, 3, 8}) {
    const Sums shared = sums_with_threads(threads, mesh, x);
    EXPECT_EQ(shared.value, alone.value);
    EXPECT_EQ(shared.gradient, alone.gradient);
    EXPECT_EQ(shared.hessian, alone.hessian);
  }
}

}  // namespace
}  // namespace aspic
