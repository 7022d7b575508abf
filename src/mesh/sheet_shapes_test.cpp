#include "mesh/sheet_shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mesh/elements.h"
#include "mesh/topology.h"

namespace aspic {
namespace {

struct Shape {
  double area = 0, least_quality = 1, least_normal = 1;  // normal: smallest cosine with the given direction
  int open_edges = 0, disagreeing = 0;
};

template <class Direction>
Shape measured(const TriMesh& surface, const Direction& direction) {
  TetMesh mesh{.rest = surface.vertices, .tets = {}, .region = {}};
  mesh.sheet = surface.triangles;
  mesh.thickness.assign(mesh.sheet.size(), 1.0);
  Shape shape;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto& [a, b, c] = mesh.triangle(e);
    const Vec3d normal = cross(mesh.rest[b] - mesh.rest[a], mesh.rest[c] - mesh.rest[a]);
    shape.area += element_volume(mesh, e);
    shape.least_quality = std::min(shape.least_quality, element_quality(mesh, e));
    shape.least_normal = std::min(shape.least_normal, dot(normal, direction(element_center(mesh, e))) / norm(normal));
  }
  const SurfaceTopology topology = aspic::topology(surface.triangles, surface.vertex_count());
  shape.open_edges = topology.open_edges;
  shape.disagreeing = static_cast<int>(topology.disagreeing.size());
  return shape;
}

Vec3d up(const Vec3d&) { return {{0, 0, 1}}; }

TEST(Rectangle, HasItsAreaAndNearlyEquilateralTriangles) {
  const TriMesh mesh = make_rectangle(2, 1, 0.1);
  const Shape shape = measured(mesh, up);
  EXPECT_NEAR(shape.area, 2, 1e-12);
  EXPECT_GT(shape.least_quality, 0.75);  // right-angled halves at the sides
  EXPECT_GT(shape.least_normal, 0.999);
  EXPECT_EQ(shape.open_edges, 2 * (20 + 12));
  EXPECT_EQ(shape.disagreeing, 0);
  EXPECT_EQ(mesh.triangle_count(), triangles_in_rectangle(2, 1, 0.1));
}

TEST(Disc, HasNearlyItsAreaAndOneBorder) {
  const TriMesh mesh = make_disc(1, 0.1);
  const Shape shape = measured(mesh, up);
  EXPECT_NEAR(shape.area, std::numbers::pi, 5e-3);
  EXPECT_GT(shape.least_quality, 0.8);
  EXPECT_GT(shape.least_normal, 0.999);
  EXPECT_EQ(shape.open_edges, 6 * 12);
  EXPECT_EQ(mesh.triangle_count(), triangles_in_disc(1, 0.1));
}

TEST(Tube, FacesOutwardAndIsOpenAtBothEnds) {
  const TriMesh mesh = make_tube(0.5, 2, 0.1);
  const Shape shape = measured(mesh, [](const Vec3d& x) {
    return (1 / std::hypot(x[0], x[1])) * Vec3d{{x[0], x[1], 0}};
  });
  EXPECT_NEAR(shape.area, 2 * std::numbers::pi, 0.02);
  EXPECT_GT(shape.least_quality, 0.9);
  EXPECT_GT(shape.least_normal, 0.99);
  EXPECT_EQ(shape.open_edges, 2 * 31);
  EXPECT_EQ(mesh.triangle_count(), triangles_in_tube(0.5, 2, 0.1));
}

TEST(SheetShapes, HaveAtLeastTheFewestTriangles) {
  EXPECT_EQ(make_rectangle(1, 1, 5).triangle_count(), 3);
  EXPECT_EQ(make_disc(1, 5).triangle_count(), 6);
  EXPECT_EQ(make_tube(1, 1, 50).triangle_count(), 6);
}

}  // namespace
}  // namespace aspic
