#include "mesh/embed.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "base/error.h"
#include "mesh/generators.h"
#include "mesh/tet_nodes.h"
#include "mesh/tet_shape.h"

namespace aspic {
namespace {

TriMesh random_skin(int count, double reach) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-reach, reach);
  TriMesh skin;
  for (int i = 0; i < count; ++i)
    skin.vertices.push_back({{coordinate(random), coordinate(random), coordinate(random)}});
  return skin;
}

std::vector<double> mapped(const std::vector<Vec3d>& points, const Mat3d& A, const Vec3d& t) {
  std::vector<double> x;
  for (const Vec3d& p : points) {
    const Vec3d y = A * p + t;
    x.insert(x.end(), {y[0], y[1], y[2]});
  }
  return x;
}

TEST(Embedding, ReproducesAffineMapsInsideAndOutside) {
  const TetMesh cage = make_sphere(1, 0.4);
  const TriMesh skin = random_skin(500, 1.2);  // the corners of the cube are well outside the ball
  const Embedding embedding = embed(cage, skin);
  EXPECT_GT(embedding.outside, 100);
  EXPECT_LT(embedding.outside, 400);
  const Mat3d A = {{1.5, 0.2, -0.3, 0.1, 0.7, 0.4, -0.6, 0.2, 1.1}};
  const Vec3d t = {{3, -2, 1}};
  std::vector<double> carried(3 * skin.vertices.size());
  carry(embedding, mapped(cage.rest, A, t), carried);
  const std::vector<double> expected = mapped(skin.vertices, A, t);
  for (size_t i = 0; i < carried.size(); ++i) ASSERT_NEAR(carried[i], expected[i], 1e-13 * 50) << i;
}

TEST(Embedding, WeightsSumToOne) {
  const Embedding embedding = embed(make_torus(1, 0.4, 0.3), random_skin(300, 1.5));
  for (const Carrier& c : embedding.carriers)
    EXPECT_NEAR(std::accumulate(c.weight.begin(), c.weight.end(), 0.0), 1, 1e-13);
}

TEST(Embedding, FindsNearestTetNotNearestCentroid) {
  // One face of a long tet is close to p; a small tet farther away has the nearer centroid.
  TetMesh cage;
  cage.rest = {{{-10, 0, 0}}, {{10, 0, 0}},  {{10, -1, 0}}, {{10, 0, -1}},
               {{0, 1, 0}},   {{0.2, 1, 0}}, {{0, 1.2, 0}}, {{0, 1, 0.2}}};
  cage.tets = {{0, 1, 3, 2}, {4, 5, 6, 7}};
  TriMesh skin;
  skin.vertices = {{{0, 0.3, 0}}};
  const Embedding embedding = embed(cage, skin);
  EXPECT_TRUE(std::equal(cage.tets[0].begin(), cage.tets[0].end(), embedding.carriers[0].vertex.begin()));
  EXPECT_EQ(embedding.outside, 1);
}

double squared_distance(const TetCorners& X, const Vec3d& p) { return squared_distance(X, barycentric(X, p), p); }

TEST(Embedding, AgreesWithSearchOfAllTets) {
  const TetMesh cage = make_torus(1, 0.3, 0.25);
  const TriMesh skin = random_skin(200, 1.6);
  const Embedding embedding = embed(cage, skin);
  for (int v = 0; v < skin.vertex_count(); ++v) {
    double nearest = 1e9;
    for (int t = 0; t < cage.tet_count(); ++t)
      nearest = std::min(nearest, squared_distance(corners(cage, t), skin.vertices[v]));
    const auto& tet = embedding.carriers[v].vertex;
    const TetCorners X = {cage.rest[tet[0]], cage.rest[tet[1]], cage.rest[tet[2]], cage.rest[tet[3]]};
    EXPECT_NEAR(squared_distance(X, skin.vertices[v]), nearest, 1e-8 * nearest);
  }
}

TEST(Embedding, CountsNoCageVertexAsOutside) {
  const TetMesh cage = make_sphere(2, 0.5);
  TriMesh skin;
  skin.vertices = cage.rest;
  const Embedding embedding = embed(cage, skin);
  EXPECT_EQ(embedding.outside, 0);
}

TEST(Embedding, SkipsFlatTets) {
  TetMesh cage = make_box({{0, 0, 0}}, {{1, 1, 1}}, {1, 1, 1});
  const int first = cage.vertex_count();
  cage.rest.insert(cage.rest.end(), {{{2, 0, 0}}, {{3, 0, 0}}, {{3, 1, 0}}, {{2, 1, 0}}});
  cage.tets.push_back({first, first + 1, first + 2, first + 3});
  TriMesh skin;
  skin.vertices = {{{2.5, 0.5, 0}}};
  const Embedding embedding = embed(cage, skin);
  for (int v : embedding.carriers[0].vertices()) EXPECT_LT(v, first);
}

TEST(Embedding, QuadraticCageCarriesQuadraticMapsInside) {
  const TetMesh cage = raise_order(make_box({{-1, -1, -1}}, {{1, 1, 1}}, {3, 3, 3}));
  const TriMesh skin = random_skin(300, 1.1);  // some vertices are outside
  const auto map = [](const Vec3d& X) {
    return Vec3d{{X[0] + 0.3 * X[1] * X[2], X[1] - 0.2 * X[0] * X[0], X[2] + 0.1 * X[0]}};
  };
  std::vector<double> x, carried(3 * skin.vertices.size());
  for (const Vec3d& X : cage.rest) {
    const Vec3d y = map(X);
    x.insert(x.end(), y.a, y.a + 3);
  }
  carry(embed(cage, skin), x, carried);
  for (int v = 0; v < skin.vertex_count(); ++v) {
    const Vec3d &X = skin.vertices[v], expected = map(X);
    const double outside = std::max({std::abs(X[0]), std::abs(X[1]), std::abs(X[2]), 1.0}) - 1;
    for (int r = 0; r < 3; ++r)  // outside along the tangent: an error of second order
      EXPECT_NEAR(carried[3 * v + r], expected[r], outside > 0 ? 0.05 : 1e-14);
  }
}

TEST(Embedding, RejectsCageWithoutVolume) {
  TriMesh skin;
  skin.vertices = {{{0, 0, 0}}};
  EXPECT_THROW(embed(TetMesh{}, skin), InvalidInput);
}

}  // namespace
}  // namespace aspic
