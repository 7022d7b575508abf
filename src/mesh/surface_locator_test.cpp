#include "mesh/surface_locator.h"

#include <gtest/gtest.h>

#include <random>

#include "mesh/distance.h"
#include "mesh/generators.h"
#include "mesh/surface.h"

namespace aspic {
namespace {

Vec3d weighted(const TriMesh& mesh, const ClosestPoint& point) {
  Vec3d x{};
  for (int c = 0; c < 3; ++c) x = x + point.weights[c] * mesh.vertices[mesh.triangles[point.triangle][c]];
  return x;
}

// The distances of distance.h are computed by another algorithm.
TEST(SurfaceLocator, AgreesWithSearchOfAllTriangles) {
  const TriMesh mesh = boundary_surface(make_sphere(1, 0.4)).surface;
  const SurfaceLocator locator(mesh.vertices, mesh.triangles);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coordinate(-1.5, 1.5);
  for (int i = 0; i < 300; ++i) {
    const Vec3d p{{coordinate(random), coordinate(random), coordinate(random)}};
    double nearest = INFINITY;
    for (const auto& [a, b, c] : mesh.triangles)
      nearest = std::min(nearest, point_triangle_distance({p, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]}).d);
    const ClosestPoint found = locator.nearest(p);
    EXPECT_NEAR(found.distance, nearest, 1e-14);
    EXPECT_NEAR(norm(found.position - p), nearest, 1e-14);
    EXPECT_LT(norm(weighted(mesh, found) - found.position), 1e-14);
    for (const double weight : found.weights) EXPECT_GT(weight, -1e-12);
  }
}

TEST(SurfaceLocator, FindsWeightsOnFlatTriangle) {
  const TriMesh mesh{{{{0, 0, 0}}, {{1, 0, 0}}, {{3, 0, 0}}}, {{0, 1, 2}}};
  const ClosestPoint found = SurfaceLocator(mesh.vertices, mesh.triangles).nearest({{2, 5, 0}});
  EXPECT_NEAR(found.distance, 5, 1e-14);
  EXPECT_LT(norm(weighted(mesh, found) - Vec3d{{2, 0, 0}}), 1e-14);
}

}  // namespace
}  // namespace aspic
