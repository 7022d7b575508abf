#include "contact/barrier.h"

#include <gtest/gtest.h>

#include <random>

#include "contact/barrier_function.h"
#include "contact/obstacle_surface.h"
#include "math/vectors.h"
#include "mesh/generators.h"
#include "mesh/surface.h"

namespace aspic {
namespace {

// Two boxes of 0.1 m, one above the other, with a gap.
struct Boxes {
  TetMesh mesh;
  std::vector<double> x;
  std::unique_ptr<Barrier> barrier;

  Boxes(double gap, double shift, double turn) {
    ContactMesh contact;
    for (const double z : {0.0, 0.1 + gap}) {
      TetMesh box = make_box({}, {{0.1, 0.1, 0.1}}, {3, 3, 3});
      const int first = mesh.vertex_count();
      std::vector<int> rows;
      for (Vec3d X : box.rest) {
        rows.push_back(mesh.vertex_count());
        if (z > 0) {
          const double c = std::cos(turn), s = std::sin(turn);
          X = {{c * X[0] - s * X[1] + shift, s * X[0] + c * X[1] + shift, X[2] + z}};
        }
        mesh.rest.push_back(X);
      }
      for (Tet t : box.tets) {
        for (int& v : t) v += first;
        mesh.tets.push_back(t);
      }
      const std::vector<Triangle> surface = boundary_triangles(box, 0, box.tet_count());
      contact.add({.name = z > 0 ? "upper" : "lower", .young = 1e5}, std::span(mesh.rest).subspan(first), surface,
                  rows);
    }
    for (const Vec3d& X : mesh.rest) x.insert(x.end(), X.a, X.a + 3);
    barrier = std::make_unique<Barrier>(std::move(contact), ContactOptions{.reach = 2e-3});
  }
  double value() const { return barrier->value(x, {}); }
  std::vector<double> gradient(const std::vector<double>& at) const {
    std::vector<double> g(at.size());
    barrier->add_gradient(at, {}, 1, g);
    return g;
  }
  void shake(double size) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-size, size);
    for (double& xi : x) xi += uniform(random);
  }
};

TEST(BarrierFunction, DerivativesMatchDifferences) {
  for (const double gap : {1e-5, 1e-4, 5e-4, 9.9e-4}) {
    const double e = 1e-4 * gap;
    const BarrierValue low = barrier(gap - e, 1e-3), b = barrier(gap, 1e-3), high = barrier(gap + e, 1e-3);
    EXPECT_NEAR(b.first, (high.value - low.value) / (2 * e), 1e-6 * std::abs(b.first) + 1e-7);
    EXPECT_NEAR(b.second, (high.first - low.first) / (2 * e), 1e-6 * b.second + 1e-6);
  }
  EXPECT_EQ(barrier(1e-3, 1e-3).second, 0);
  EXPECT_TRUE(std::isinf(barrier(0, 1e-3).value));
}

TEST(Barrier, GradientMatchesDifferences) {
  for (const double turn : {0.0, 0.3}) {
    Boxes boxes(4e-4, 0.013, turn);
    boxes.shake(1e-4);
    ASSERT_GT(boxes.value(), 0);
    const std::vector<double> g = boxes.gradient(boxes.x);
    const double size = max_abs(g);
    for (size_t i = 0; i < boxes.x.size(); ++i) {
      if (g[i] == 0) continue;
      const double e = 1e-9, x = boxes.x[i];
      boxes.x[i] = x + e;
      const double high = boxes.value();
      boxes.x[i] = x - e;
      const double low = boxes.value();
      boxes.x[i] = x;
      EXPECT_NEAR(g[i], (high - low) / (2 * e), 1e-5 * size) << i;
    }
  }
}

// A triangle near a sphere and a capsule, which is closest at its interior, an edge, a corner, or an end of the
// capsule.
TEST(Barrier, RoundObstaclesHaveExactDerivatives) {
  ContactMesh mesh;
  const std::vector<Vec3d> X = {{{0, 0, 0}}, {{1, 0.05, 0}}, {{0.1, 1, 0.02}}};
  mesh.add({.name = "body", .young = 1e5}, X, std::vector<Triangle>{{0, 1, 2}}, std::vector<int>{0, 1, 2});
  mesh.add_capsule({.name = "ball", .offset = 0.5}, {Vec3d{{0.3, 0.3, 0.56}}, Vec3d{{0.3, 0.3, 0.56}}});
  mesh.add_capsule({.name = "rod", .offset = 0.2}, {Vec3d{{0.2, -0.3, 0.22}}, Vec3d{{0.9, 0.8, 0.26}}});
  mesh.add_capsule({.name = "end", .offset = 0.1}, {Vec3d{{0.25, 0.35, -0.15}}, Vec3d{{0.3, 0.3, -1}}});
  const Barrier barrier(std::move(mesh), {.reach = 0.1});
  std::vector<double> x, v = {0.3, -0.7, 0.2, 0.5, 0.1, -0.4, -0.6, 0.9, 0.8};
  for (const Vec3d& at : X) x.insert(x.end(), at.a, at.a + 3);
  ASSERT_GE(barrier.summary(x, 0).contacts, 4);
  const auto gradient = [&](double s) {
    std::vector<double> at = x, g(9);
    add_scaled(s, v, at);
    barrier.add_gradient(at, {}, 1, g);
    return g;
  };
  const auto value = [&](double s) {
    std::vector<double> at = x;
    add_scaled(s, v, at);
    return barrier.value(at, {});
  };
  const double e = 1e-6;
  EXPECT_NEAR(dot(gradient(0), v), (value(e) - value(-e)) / (2 * e), 1e-6 * norm(gradient(0)));
  const BlockPattern pattern = make_pattern(3, {});
  BlockSparse H(pattern);
  barrier.add_hessian(x, {}, 1, {}, H);
  std::vector<double> Hv(9);
  H.multiply(v, Hv);
  const std::vector<double> high = gradient(e), low = gradient(-e);
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(Hv[i], (high[i] - low[i]) / (2 * e), 1e-5 * max_abs(Hv)) << i;
}

// Obstacles that advance along a direction: a plane, a ball and a plate below a triangle.
TEST(Barrier, ObstacleMotionChangesGradientToFirstOrder) {
  const std::vector<Vec3d> X = {{{0, 0.05, 0}}, {{1, 0.03, 0}}, {{0.1, 0.06, 1}}};
  const std::vector<Vec3d> plate = {{{-1, -0.04, -1}}, {{2, -0.04, -1}}, {{0, -0.02, 3}}};
  const auto moving = [](const char* name, const Vec3d& velocity) {
    const auto motion = [velocity](double time, std::span<const Vec3d> start, std::span<Vec3d> x) {
      for (size_t i = 0; i < x.size(); ++i) x[i] = start[i] + time * velocity;
    };
    return ContactPart{.name = name, .is_obstacle = true, .motion = motion};
  };
  ContactMesh mesh;
  mesh.add({.name = "body", .young = 1e5}, X, std::vector<Triangle>{{0, 1, 2}}, std::vector<int>{0, 1, 2});
  mesh.add_plane(moving("plane", {{0.2, 1, 0}}), {{0, 0, 0}}, {{0, 1, 0}});
  ContactPart ball = moving("ball", {{0.5, -1, 0.1}});
  ball.offset = 0.5;
  mesh.add_capsule(ball, {Vec3d{{0.3, 0.62, 0.3}}, Vec3d{{0.3, 0.62, 0.3}}});
  mesh.add(moving("plate", {{0, 0.7, 0.3}}), plate, std::vector<Triangle>{{0, 2, 1}}, {});
  const Barrier barrier(std::move(mesh), {.reach = 0.1});
  std::vector<double> x;
  for (const Vec3d& at : X) x.insert(x.end(), at.a, at.a + 3);
  ASSERT_GE(barrier.summary(x, 0).contacts, 7);
  const auto gradient = [&](double time, std::optional<double> end) {
    Energy::Context context;
    context.time = time;
    context.obstacle_end = end;
    std::vector<double> g(9);
    barrier.add_gradient(x, context, 1, g);
    return g;
  };
  const double e = 1e-7;
  const std::vector<double> at_start = gradient(0, {}), pulled = gradient(0, e);
  const std::vector<double> high = gradient(e, {}), low = gradient(-e, {});
  for (int i = 0; i < 9; ++i)
    EXPECT_NEAR((pulled[i] - at_start[i]) / e, (high[i] - low[i]) / (2 * e), 1e-5 * max_abs(at_start) / 0.01) << i;
}

TEST(Barrier, ExactHessianMatchesDifferences) {
  Boxes boxes(4e-4, 0.013, 0.3);
  boxes.shake(1e-4);
  const int n = boxes.mesh.vertex_count();
  const BlockPattern pattern = make_pattern(n, {});
  BlockSparse H(pattern);
  boxes.barrier->add_hessian(boxes.x, {}, 1, {}, H);
  ASSERT_FALSE(H.stencils.empty());
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<double> v(3 * n), Hv(3 * n), high = boxes.x, low = boxes.x;
  for (double& vi : v) vi = uniform(random);
  H.multiply(v, Hv);
  const double e = 1e-9;
  add_scaled(e, v, high);
  add_scaled(-e, v, low);
  const std::vector<double> g_high = boxes.gradient(high), g_low = boxes.gradient(low);
  for (int i = 0; i < 3 * n; ++i) EXPECT_NEAR(Hv[i], (g_high[i] - g_low[i]) / (2 * e), 1e-4 * max_abs(Hv)) << i;
}

TEST(Barrier, ModifiedHessianIsSemidefinite) {
  Boxes boxes(4e-4, 0.013, 0.3);
  boxes.shake(1e-4);
  const BlockPattern pattern = make_pattern(boxes.mesh.vertex_count(), {});
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (const Definiteness kind : {Definiteness::clamped, Definiteness::absolute}) {
    BlockSparse H(pattern);
    boxes.barrier->add_hessian(boxes.x, {}, 1, {kind}, H);
    for (int k = 0; k < 100; ++k) {
      std::vector<double> v(boxes.x.size()), Hv(v.size());
      for (double& vi : v) vi = normal(random);
      H.multiply(v, Hv);
      EXPECT_GE(dot(v, Hv), -1e-12 * norm(v) * norm(Hv));
    }
  }
}

TEST(Barrier, ForcesBalance) {
  Boxes boxes(4e-4, 0.013, 0.3);
  boxes.shake(1e-4);
  const std::vector<double> g = boxes.gradient(boxes.x);
  Vec3d force{}, moment{};
  double size = 0;
  for (int v = 0; v < boxes.mesh.vertex_count(); ++v) {
    force = force + vec_at(g, v);
    moment = moment + cross(vec_at(boxes.x, v), vec_at(g, v));
    size += norm(vec_at(g, v));
  }
  EXPECT_LT(norm(force), 1e-12 * size);
  EXPECT_LT(norm(moment), 1e-12 * size);
}

TEST(Barrier, PressureOfFlatSurfacesIsUniform) {
  const Boxes boxes(1e-3, 0, 0);
  const std::vector<double> g = boxes.gradient(boxes.x);
  const ContactMesh& contact = boxes.barrier->mesh();
  const double pressure = -1e4 * barrier(1e-3, 2e-3).first;  // kappa |b'|
  for (int p = 0; p < contact.point_count(); ++p) {
    const Vec3d& X = contact.rest[p];
    const bool is_on_face = std::abs(X[2] - 0.1) < 2e-3;
    const bool is_on_border = X[0] < 1e-3 || X[0] > 0.099 || X[1] < 1e-3 || X[1] > 0.099;
    const Vec3d force = vec_at(g, contact.row[p]);
    if (is_on_face && !is_on_border) {
      EXPECT_NEAR(std::abs(force[2]), pressure * contact.area[p], 1e-12);
    }
    if (!is_on_face) {
      EXPECT_EQ(norm(force), 0);
    }
  }
  const ContactSummary summary = boxes.barrier->summary(boxes.x, 0);
  EXPECT_GT(summary.contacts, 0);
  EXPECT_NEAR(summary.min_gap, 1e-3, 1e-15);
}

TEST(Barrier, StepStopsBeforeSurfacesTouch) {
  Boxes boxes(0.02, 0.013, 0.3);
  EXPECT_EQ(boxes.value(), 0);
  std::vector<double> d(boxes.x.size());
  for (int v = boxes.mesh.vertex_count() / 2; v < boxes.mesh.vertex_count(); ++v) d[3 * v + 2] = -0.1;
  const double step = boxes.barrier->max_step(boxes.x, {}, d);
  EXPECT_LT(step, 0.2);
  EXPECT_GT(step, 0.17);
  add_scaled(step, d, boxes.x);
  EXPECT_TRUE(std::isfinite(boxes.value()));
  EXPECT_GT(boxes.value(), 0);
}

// The share of a tip in the integral is (fine / coarse triangle)^3, about 1e-8 here.
TEST(Barrier, GuardsTipsOfCoarseSurfaces) {
  const TetMesh box = make_box({{-0.5, 0, -0.5}}, {{0.5, 0.2, 0.5}}, {10, 2, 10});
  std::vector<int> rows;
  std::vector<double> x;
  for (const Vec3d& X : box.rest) {
    rows.push_back(static_cast<int>(rows.size()));
    x.insert(x.end(), X.a, X.a + 3);
  }
  const double reach = 2e-3, gap = reach / 20;
  ContactMesh contact;
  contact.add({.name = "box", .young = 1e5}, box.rest, boundary_triangles(box, 0, box.tet_count()), rows);
  const std::vector<Vec3d> spike = {{{-2, -3, -2}}, {{2, -3, -2}}, {{2, -3, 2}}, {{-2, -3, 2}}, {{0.013, -gap, 0.027}}};
  contact.add({.name = "spike", .is_obstacle = true}, spike,
              std::vector<Triangle>{{0, 4, 1}, {1, 4, 2}, {2, 4, 3}, {3, 4, 0}, {0, 1, 2}, {0, 2, 3}}, {});
  const Barrier barrier(std::move(contact), ContactOptions{.reach = reach});
  std::vector<double> g(x.size());
  barrier.add_gradient(x, {}, 1, g);
  double force = 0;
  for (size_t i = 1; i < g.size(); i += 3) force -= g[i];
  const double area = barrier.mesh().parts[0].mean_triangle, kappa = barrier.laws()(1, 0).stiffness;
  const double expected = -kappa * area * aspic::barrier(gap, reach / 4).first;
  EXPECT_NEAR(force, expected, 1e-3 * expected);
}

// All points of the two facing sides are in contact, with the pressure kappa |b'| of their gap.
TEST(Barrier, ContactPointsHavePressureOfTheirGap) {
  const double gap = 5e-4;
  const Boxes boxes(gap, 0, 0);
  const std::vector<ContactPoint> points = boxes.barrier->contact_points(boxes.x, 0);
  ASSERT_EQ(points.size(), 32U);
  const double kappa = boxes.barrier->laws()(0, 1).stiffness;
  for (const ContactPoint& point : points) {
    EXPECT_NEAR(point.gap, gap, 1e-12);
    EXPECT_NEAR(point.pressure, -kappa * barrier(gap, 2e-3).first, 1e-6 * kappa);
    EXPECT_EQ(point.position[2] < 0.1 + gap / 2, point.row < boxes.mesh.vertex_count() / 2);
  }
  EXPECT_DOUBLE_EQ(boxes.barrier->summary(boxes.x, 0).max_pressure, points.front().pressure);
}

TEST(ObstacleSurface, PlaneIsSquareBelowBodies) {
  ContactMesh mesh;
  const std::vector<Vec3d> X = {{{0, 1, 0}}, {{1, 1, 0}}, {{0, 1, 1}}};
  mesh.add({.name = "body"}, X, std::vector<Triangle>{{0, 1, 2}}, std::vector<int>{0, 1, 2});
  mesh.add_plane({.name = "slope"}, {{0, 0, 0}}, {{1, 2, 0}});
  mesh.add({.name = "sheet", .is_obstacle = true}, X, std::vector<Triangle>{{0, 2, 1}}, {});
  const std::vector<ObstacleSurface> surfaces = obstacle_surfaces(mesh, mesh.rest);
  ASSERT_EQ(surfaces.size(), 2U);
  EXPECT_EQ(surfaces[0].name, "slope");
  const TriMesh& square = surfaces[0].surface;
  ASSERT_EQ(square.vertex_count(), 4);
  for (const Vec3d& x : square.vertices) EXPECT_NEAR(x[0] + 2 * x[1], 0, 1e-12);
  const auto& [a, b, c] = square.triangles[0];
  const Vec3d normal = cross(square.vertices[b] - square.vertices[a], square.vertices[c] - square.vertices[a]);
  EXPECT_GT(normal[1], 0) << "the square must face the bodies";
  EXPECT_FALSE(surfaces[1].plane);
  EXPECT_EQ(surfaces[1].surface.triangles, (std::vector<Triangle>{{0, 2, 1}}));
  EXPECT_DOUBLE_EQ(surfaces[1].surface.vertices[1][0], 1);
}

}  // namespace
}  // namespace aspic
