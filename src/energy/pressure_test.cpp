#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dynamics/step_derivatives.h"
#include "energy/pressure.h"
#include "energy/surface_box_test.h"

namespace aspic {
namespace {

std::vector<Triangle> top() {
  std::vector<Triangle> triangles;
  for (const Triangle& t : box_surface())
    if (std::all_of(t.begin(), t.end(), [](int v) { return box_mesh().rest[v][2] > 0.6 - 1e-9; }))
      triangles.push_back(t);
  return triangles;
}

TEST(Pressure, DerivativesMatchDifferences) {
  for (const double p : {3.0, -3.0}) {
    const auto V = make_pressure(box_mesh(), linear_faces(top()), p);
    V->bind(box_pattern());
    const std::vector<double> x = shaken_box(0.05);
    const DerivativeReport report =
        check_derivatives(differentiable(ActiveTerm(*V), box_pattern()), x, {.length = 0.3});
    EXPECT_TRUE(report.gradient.passed) << report.gradient.smallest_error;
    EXPECT_TRUE(report.hessian.passed) << report.hessian.smallest_error;
  }
}

TEST(Pressure, HasNoResultantOnClosedSurface) {
  const auto V = make_pressure(box_mesh(), linear_faces(box_surface()), 3);
  const std::vector<double> x = shaken_box(0.05);
  double volume = 0;  // volume of the deformed body
  for (const Tet& tet : box_mesh().tets) {
    const auto at = [&](int k) { return Vec3d{{x[3 * tet[k]], x[3 * tet[k] + 1], x[3 * tet[k] + 2]}}; };
    volume += determinant(from_columns(at(1) - at(0), at(2) - at(0), at(3) - at(0))) / 6;
  }
  EXPECT_NEAR(V->value(x), 3 * (volume - 0.48), 1e-14);
  std::vector<double> g(x.size());
  V->add_gradient(x, 1, g);
  Vec3d force{}, torque{};
  for (size_t i = 0; i < x.size(); i += 3) {
    const Vec3d f = {{g[i], g[i + 1], g[i + 2]}};
    force = force + f;
    torque = torque + cross(Vec3d{{x[i], x[i + 1], x[i + 2]}}, f);
  }
  EXPECT_LT(norm(force), 1e-14);
  EXPECT_LT(norm(torque), 1e-14);
}

TEST(Pressure, IsPressureTimesAreaOnMovingPatch) {
  const auto V = make_pressure(box_mesh(), linear_faces(top()), 3);
  std::vector<double> x = box_at_rest();
  for (size_t i = 2; i < x.size(); i += 3) x[i] *= 0.9;
  EXPECT_NEAR(V->swept_volume(x), -0.06 * 0.8, 1e-15);
  std::vector<double> g(x.size());
  V->add_gradient(x, -1, g);
  Vec3d force{};
  for (size_t i = 0; i < x.size(); ++i) force[i % 3] += g[i];
  EXPECT_NEAR(force[2], -3 * 0.8, 1e-14);
}

TEST(Pressure, FollowsSurfaceInsidePatch) {
  const auto V = make_pressure(box_mesh(), linear_faces(top()), 3);
  const std::vector<double> x = shaken_box(0.05);
  const auto at = [&](int v) { return Vec3d{{x[3 * v], x[3 * v + 1], x[3 * v + 2]}}; };
  std::vector<double> g(x.size());
  V->add_gradient(x, -1, g);
  int inner = 0;
  for (int v = 0; v < box_mesh().vertex_count(); ++v) {
    const Vec3d& X = box_mesh().rest[v];
    if (X[2] < 0.6 - 1e-9 || X[0] < 1e-9 || X[0] > 1 - 1e-9 || X[1] < 1e-9 || X[1] > 0.8 - 1e-9) continue;
    ++inner;
    Vec3d force{};  // sum of -p dA / 3 over the triangles at the vertex
    for (const Triangle& t : top())
      if (std::find(t.begin(), t.end(), v) != t.end())
        force = force + (-3.0 / 6) * cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0]));
    for (int r = 0; r < 3; ++r) EXPECT_NEAR(g[3 * v + r], force[r], 1e-14);
  }
  EXPECT_EQ(inner, 6);
}

TEST(Pressure, ModifiedHessianIsPositiveSemidefinite) {
  const auto V = make_pressure(box_mesh(), linear_faces(top()), 3);
  V->bind(box_pattern());
  const std::vector<double> x = shaken_box(0.05);
  for (const Definiteness kind : {Definiteness::exact, Definiteness::clamped, Definiteness::absolute}) {
    BlockSparse H(box_pattern());
    V->add_hessian(x, 1, {kind}, H);
    double least = 0;
    for (unsigned seed = 0; seed < 100; ++seed) {
      std::vector<double> d = shaken_box(1, seed), Hd(x.size());
      H.multiply(d, Hd);
      least = std::min(least, std::inner_product(d.begin(), d.end(), Hd.begin(), 0.0));
    }
    EXPECT_EQ(least < -1e-6, kind == Definiteness::exact) << least;
  }
}

}  // namespace
}  // namespace aspic
