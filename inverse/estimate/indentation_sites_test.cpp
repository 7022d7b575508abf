#include "estimate/indentation_sites.h"

#include <gtest/gtest.h>

#include "mesh/generators.h"

namespace aspic {
namespace {

TEST(IndentationSites, AreFarApartOnFreeFlatSurface) {
  const TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 0.5}}, {8, 8, 4});
  std::vector<int> fixed;
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (mesh.rest[v][2] < 1e-9) fixed.push_back(v);
  const std::vector<IndentationSite> sites = indentation_sites(mesh, fixed, 0.1, 9);
  ASSERT_EQ(sites.size(), 9u);
  for (const IndentationSite& site : sites) {
    const Vec3d& X = mesh.rest[site.vertex];
    EXPECT_GT(X[2], 0.1);
    int faces = 0, normal = 0;  // not on an edge
    for (int i = 0; i < 3; ++i) {
      const double upper = i == 2 ? 0.5 : 1;
      faces += X[i] < 1e-9 || X[i] > upper - 1e-9;
      if (X[i] < 1e-9) normal += site.inward[i] > 0.9;
      if (X[i] > upper - 1e-9) normal += site.inward[i] < -0.9;
    }
    EXPECT_EQ(faces, 1);
    EXPECT_EQ(normal, 1);
    for (const IndentationSite& other : sites)
      if (other.vertex != site.vertex) {
        const Vec3d d = mesh.rest[other.vertex] - X;
        EXPECT_GT(dot(d, d), 0.25 * 0.25);
      }
  }
  EXPECT_TRUE(indentation_sites(mesh, fixed, 1, 9).empty());
}

TEST(IndentationSites, OfASphereAreAllOverIt) {
  const TetMesh mesh = make_sphere(1, 0.3);
  const std::vector<IndentationSite> sites = indentation_sites(mesh, {}, 0.3, 12);
  ASSERT_EQ(sites.size(), 12u);
  Vec3d sum{};
  for (const IndentationSite& site : sites) {
    sum = sum + mesh.rest[site.vertex];
    EXPECT_GT(-1.0 * dot(site.inward, mesh.rest[site.vertex]), 0.97);
  }
  EXPECT_LT(dot(sum, sum), 4);
}

}  // namespace
}  // namespace aspic
