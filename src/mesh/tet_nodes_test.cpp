#include "mesh/tet_nodes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "mesh/generators.h"
#include "mesh/numbering.h"
#include "mesh/surface.h"
#include "mesh/tet_shape.h"

namespace aspic {
namespace {

TetMesh linear_box() { return make_box({{0, 0, 0}}, {{2, 1, 1}}, {3, 2, 2}); }

double enclosed(const TriMesh& surface) {
  double six_volumes = 0;
  for (const auto& [a, b, c] : surface.triangles)
    six_volumes += dot(surface.vertices[a], cross(surface.vertices[b], surface.vertices[c]));
  return six_volumes / 6;
}

TEST(RaiseOrder, AddsOneNodePerEdgeAtMidpoint) {
  const TetMesh linear = linear_box(), mesh = raise_order(linear);
  std::set<std::pair<int, int>> edges;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const TetNodes nodes = nodes_of(mesh, t);
    ASSERT_EQ(nodes.count, 10);
    for (int k = 0; k < 6; ++k) {
      const int a = nodes[kTetEdges[k][0]], b = nodes[kTetEdges[k][1]];
      edges.insert(std::minmax(a, b));
      EXPECT_GE(nodes[4 + k], linear.vertex_count());
      EXPECT_EQ(norm(mesh.rest[nodes[4 + k]] - 0.5 * (mesh.rest[a] + mesh.rest[b])), 0);
    }
  }
  EXPECT_EQ(mesh.vertex_count(), linear.vertex_count() + static_cast<int>(edges.size()));
  EXPECT_TRUE(std::equal(linear.tets.begin(), linear.tets.end(), mesh.tets.begin()));
}

TEST(LowerOrder, RestoresLinearMesh) {
  const TetMesh linear = linear_box(), mesh = lower_order(raise_order(linear));
  EXPECT_EQ(mesh.tets, linear.tets);
  EXPECT_TRUE(mesh.mids.empty());
  ASSERT_EQ(mesh.vertex_count(), linear.vertex_count());
  for (int v = 0; v < mesh.vertex_count(); ++v) EXPECT_EQ(norm(mesh.rest[v] - linear.rest[v]), 0);
}

TEST(FacesOf, JoinsFourTrianglesToQuadraticFace) {
  const TetMesh mesh = raise_order(linear_box());
  std::vector<Triangle> triangles = boundary_triangles(mesh, 0, mesh.tet_count());
  triangles.erase(triangles.begin());
  const std::vector<Face> faces = faces_of(mesh, triangles);
  const auto is_quadratic = [](const Face& face) { return face.is_quadratic(); };
  EXPECT_EQ(std::count_if(faces.begin(), faces.end(), is_quadratic), static_cast<int>(triangles.size() / 4));
  EXPECT_EQ(faces.size(), triangles.size() / 4 + 3) << "three triangles of an incomplete face";
}

TEST(NodesOf, LinearTetHasFourCorners) {
  const TetMesh mesh = linear_box();
  const TetNodes nodes = nodes_of(mesh, 7);
  EXPECT_EQ(nodes.count, 4);
  EXPECT_TRUE(std::equal(nodes.begin(), nodes.end(), mesh.tets[7].begin()));
}

TEST(LinearParts, EightPositiveEqualVolumes) {
  const TetMesh mesh = raise_order(linear_box());
  const LinearParts parts = linear_parts(mesh);
  ASSERT_EQ(parts.mesh.tet_count(), 8 * mesh.tet_count());
  for (int p = 0; p < parts.mesh.tet_count(); ++p)
    EXPECT_NEAR(volume(parts.mesh, p), volume(mesh, parts.tet[p]) / 8, 1e-15);
}

TEST(Boundary, QuadraticFaceBecomesFourTriangles) {
  const TetMesh linear = linear_box(), mesh = raise_order(linear);
  const BoundarySurface before = boundary_surface(linear), after = boundary_surface(mesh);
  EXPECT_EQ(after.surface.triangle_count(), 4 * before.surface.triangle_count());
  EXPECT_NEAR(enclosed(after.surface), 2, 1e-14);  // closed and outward oriented
  EXPECT_EQ(boundary_surface(linear_parts(mesh).mesh).surface.vertex_count(), after.surface.vertex_count());
}

TEST(Renumbering, KeepsMidNodesOnTheirEdges) {
  const TetMesh user = raise_order(linear_box());
  const Numbering numbering = locality_numbering(user);
  const TetMesh stored = from_user(numbering, user);
  for (int t = 0; t < stored.tet_count(); ++t)
    for (int k = 0; k < 6; ++k) {
      const Vec3d midpoint =
          0.5 * (stored.rest[stored.tets[t][kTetEdges[k][0]]] + stored.rest[stored.tets[t][kTetEdges[k][1]]]);
      EXPECT_EQ(norm(stored.rest[stored.mids[t][k]] - midpoint), 0);
    }
  EXPECT_EQ(to_user(numbering, stored).mids, user.mids);
}

}  // namespace
}  // namespace aspic
