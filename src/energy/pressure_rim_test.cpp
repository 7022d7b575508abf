// Follower pressure on open patches: the swept volume with its rim.
#include "energy/pressure_rim.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "dynamics/step_derivatives.h"
#include "energy/pressure.h"
#include "energy/quadratic_face.h"
#include "math/vectors.h"
#include "mesh/generators.h"
#include "mesh/tet_nodes.h"

namespace aspic {
namespace {

constexpr double kPressure = 3;

std::vector<double> shaken(const TetMesh& mesh, unsigned seed, double amount) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-amount, amount);
  std::vector<double> x;
  for (const Vec3d& X : mesh.rest)
    for (const double c : {1.1 * X[0] + 0.2 * X[1], X[1] - 0.1 * X[2], 0.9 * X[2] + 0.3 * X[0]})
      x.push_back(c + uniform(random));
  return x;
}

// A pressure on the top of a box, which is an open patch.
struct Top {
  explicit Top(bool is_quadratic) : mesh(make_box({{0, 0, 0}}, {{1, 0.8, 0.6}}, {3, 2, 1})) {
    if (is_quadratic) mesh = raise_order(mesh);
    for (const Face& face : boundary_faces(mesh, 0, mesh.tet_count()))
      if (std::all_of(face.corners.begin(), face.corners.end(), [&](int v) { return mesh.rest[v][2] > 0.59; }))
        patch.push_back(face);
    swept = make_pressure(mesh, patch, kPressure);
    rim = make_pressure_rim(*swept, mesh, rim_of(patch), [](double) { return kPressure; });
    Couplings couplings;
    swept->add_couplings(couplings);
    pattern = make_pattern(mesh.vertex_count(), couplings);
    swept->bind(pattern);
    rim->bind(pattern);
  }

  // p r at x, lagged there.
  std::vector<double> rim_forces(const std::vector<double>& x) const {
    std::vector<double> g(x.size());
    ActiveTerm(*rim, {.start = x}).add_gradient(x, -1, g);
    return g;
  }

  TetMesh mesh;
  std::vector<Face> patch;
  std::unique_ptr<Pressure> swept;
  std::unique_ptr<PressureRim> rim;
  BlockPattern pattern;
};

// Position on a face at barycentric coordinates, from the shape functions.
Vec3d on_face(const Face& face, const std::vector<double>& x, double l1, double l2) {
  const double l0 = 1 - l1 - l2;
  if (!face.is_quadratic())
    return l0 * point(x, face.corners[0]) + l1 * point(x, face.corners[1]) + l2 * point(x, face.corners[2]);
  const std::array<double, 6> N = face_shapes({l0, l1, l2});
  Vec3d sum{};
  for (int n = 0; n < 6; ++n) sum = sum + N[n] * point(x, nodes_of(face)[n]);
  return sum;
}

// Virtual work of the pressure on dx, by a midpoint rule on a fine grid of each deformed face.
double virtual_work(const Top& top, const std::vector<double>& x, const std::vector<double>& dx) {
  constexpr int kParts = 60;
  constexpr double h = 1.0 / kParts, kStep = 1e-5;
  double work = 0;
  for (const Face& face : top.patch)
    for (int i = 0; i < kParts; ++i)
      for (int j = 0; i + j < kParts; ++j)
        for (int half = 0; half < (i + j + 1 < kParts ? 2 : 1); ++half) {
          const double shift = half == 0 ? 1.0 / 3 : 2.0 / 3, a = (i + shift) * h, b = (j + shift) * h;
          const Vec3d along = (0.5 / kStep) * (on_face(face, x, a + kStep, b) - on_face(face, x, a - kStep, b));
          const Vec3d across = (0.5 / kStep) * (on_face(face, x, a, b + kStep) - on_face(face, x, a, b - kStep));
          work -= kPressure * 0.5 * h * h * dot(cross(along, across), on_face(face, dx, a, b));
        }
  return work;
}

TEST(PressureRim, ForcesActOnDeformedArea) {
  for (const bool is_quadratic : {false, true}) {
    const Top top(is_quadratic);
    const std::vector<double> x = shaken(top.mesh, 1, 0.05);
    std::vector<double> force(x.size());
    top.swept->add_gradient(x, -1, force);
    const double without_rim = dot(force, shaken(top.mesh, 2, 1));
    ActiveTerm(*top.rim, {.start = x}).add_gradient(x, -1, force);
    for (const unsigned seed : {2u, 3u, 4u}) {
      const std::vector<double> dx = shaken(top.mesh, seed, 1);
      const double expected = virtual_work(top, x, dx);
      EXPECT_NEAR(dot(force, dx), expected, 2e-4 * std::abs(expected));
    }
    EXPECT_GT(std::abs(without_rim - virtual_work(top, x, shaken(top.mesh, 2, 1))), 2e-3 * std::abs(without_rim));
  }
}

TEST(PressureRim, DerivativesMatchDifferences) {
  for (const bool is_quadratic : {false, true}) {
    const Top top(is_quadratic);
    const std::vector<double> start = shaken(top.mesh, 1, 0.05), x = shaken(top.mesh, 2, 0.1);
    const DerivativeReport report =
        check_derivatives(differentiable(ActiveTerm(*top.rim, {.start = start}), top.pattern), x, {.length = 0.2});
    EXPECT_TRUE(report.gradient.passed) << report.gradient.smallest_error;
    EXPECT_TRUE(report.hessian.passed) << report.hessian.smallest_error;
  }
}

TEST(PressureRim, HessianIsSymmetricPartOfTangent) {
  for (const bool is_quadratic : {false, true}) {
    const Top top(is_quadratic);
    const std::vector<double> x = shaken(top.mesh, 1, 0.05), a = shaken(top.mesh, 2, 1), b = shaken(top.mesh, 3, 1);
    BlockSparse H(top.pattern);
    ActiveTerm(*top.rim, {.start = x}).add_hessian(x, 1, {}, H);
    const auto tangent = [&](const std::vector<double>& left, const std::vector<double>& right) {
      constexpr double kStep = 1e-4;  // r is quadratic in x, so that central differences are exact
      std::vector<double> forth = x, back = x;
      add_scaled(kStep, right, forth);
      add_scaled(-kStep, right, back);
      return -(dot(left, top.rim_forces(forth)) - dot(left, top.rim_forces(back))) / (2 * kStep);
    };
    std::vector<double> Hb(x.size());
    H.multiply(b, Hb);
    const double ab = tangent(a, b), ba = tangent(b, a);
    EXPECT_NEAR(dot(a, Hb), 0.5 * (ab + ba), 1e-8 * std::abs(ab));
    EXPECT_GT(std::abs(ab - ba), 1e-3 * std::abs(ab));
  }
}

TEST(PressureRim, ClosedSurfaceHasNone) {
  for (const bool is_quadratic : {false, true}) {
    const Top top(is_quadratic);
    EXPECT_TRUE(rim_of(boundary_faces(top.mesh, 0, top.mesh.tet_count())).empty());
    EXPECT_EQ(rim_of(top.patch).size(), 10u);
  }
}

}  // namespace
}  // namespace aspic
