#include "mesh/close_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "base/parallel.h"
#include "mesh/distance.h"
#include "mesh/generators.h"
#include "mesh/surface.h"
#include "mesh/topology.h"

namespace aspic {
namespace {

using PairList = std::vector<std::array<int, 2>>;

struct Scene {
  SurfacePrimitives primitives;
  std::vector<Vec3d> x, dx;
  std::vector<double> vertex_radius, edge_radius, triangle_radius;
  std::vector<char> is_new;

  void add(const TriMesh& mesh, const Vec3d& shift) {
    const int first = static_cast<int>(x.size());
    for (const Vec3d& p : mesh.vertices) {
      primitives.vertices.push_back(static_cast<int>(x.size()));
      x.push_back(p + shift);
    }
    for (const auto& [a, b, c] : mesh.triangles) primitives.triangles.push_back({a + first, b + first, c + first});
    for_each_edge(edge_uses(mesh.triangles), [&](const EdgeUse* use, const EdgeUse*) {
      primitives.edges.push_back({use->edge[0] + first, use->edge[1] + first});
    });
  }
  void set_radius(double radius) {
    vertex_radius.assign(primitives.vertices.size(), radius);
    triangle_radius.assign(primitives.triangles.size(), radius);
    edge_radius.assign(primitives.edges.size(), radius / 4);
  }
};

ClosePairs find(PairFinder& finder, const Scene& scene, const PairFilter* filter = nullptr, size_t limit = 1 << 20) {
  return finder.find({.x = scene.x,
                      .dx = scene.dx,
                      .vertex_radius = scene.vertex_radius,
                      .edge_radius = scene.edge_radius,
                      .triangle_radius = scene.triangle_radius,
                      .is_new = scene.is_new,
                      .filter = filter,
                      .limit = limit});
}

// Returns whether boxes around two primitives, seen from the other primitive, come closer than the radius.
template <class A, class B>
bool meet(const Scene& scene, const A& a, const B& b, double radius) {
  for (int axis = 0; axis < 3; ++axis) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    double least = kInfinity, most = -kInfinity, closing = 0, opening = 0;
    for (const int i : a)
      for (const int j : b) {
        const double apart = scene.x[i][axis] - scene.x[j][axis], change = scene.dx[i][axis] - scene.dx[j][axis];
        least = std::min(least, apart), most = std::max(most, apart);
        closing = std::max(closing, -change), opening = std::max(opening, change);
      }
    if (least - closing > radius || most + opening < -radius) return false;
  }
  return true;
}

// Tests all pairs.
ClosePairs brute_force(const Scene& scene) {
  const auto& [vertices, edges, triangles] = scene.primitives;
  ClosePairs pairs;
  for (int v = 0; v < static_cast<int>(vertices.size()); ++v)
    for (int t = 0; t < static_cast<int>(triangles.size()); ++t)
      if (meet(scene, std::array{vertices[v]}, triangles[t], scene.vertex_radius[v] + scene.triangle_radius[t]) &&
          std::find(triangles[t].begin(), triangles[t].end(), vertices[v]) == triangles[t].end())
        pairs.vertex_triangle.push_back({v, t});
  for (int a = 0; a < static_cast<int>(edges.size()); ++a)
    for (int b = a + 1; b < static_cast<int>(edges.size()); ++b)
      if (meet(scene, edges[a], edges[b], scene.edge_radius[a] + scene.edge_radius[b]) &&
          !lists_vertex_twice(std::array{edges[a][0], edges[a][1], edges[b][0], edges[b][1]}))
        pairs.edge_edge.push_back({a, b});
  return pairs;
}

// Two spheres that nearly touch, with random displacements.
Scene two_spheres(unsigned seed, double speed) {
  Scene scene;
  const TriMesh sphere = boundary_surface(make_sphere(1, 0.25)).surface;
  scene.add(sphere, {{0.013, 0.021, 0.034}});
  scene.add(sphere, {{2.03, 0.1, 0.05}});
  scene.set_radius(0.02);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, speed);
  scene.dx.resize(scene.x.size());
  for (Vec3d& dx : scene.dx) dx = {{normal(random), normal(random), normal(random)}};
  return scene;
}

void expect_equal(const ClosePairs& a, const ClosePairs& b) {
  EXPECT_TRUE(a.vertex_triangle == b.vertex_triangle);
  EXPECT_TRUE(a.edge_edge == b.edge_edge);
  EXPECT_EQ(a.is_complete, b.is_complete);
}

TEST(PairFinder, AgreesWithBruteForceWhileSurfacesMove) {
  Scene scene = two_spheres(1, 0.02);
  PairFinder finder(scene.primitives);
  for (int step = 0; step < 5; ++step) {
    const ClosePairs pairs = find(finder, scene);
    expect_equal(pairs, brute_force(scene));
    EXPECT_GT(pairs.vertex_triangle.size(), 10);
    EXPECT_GT(pairs.edge_edge.size(), 100);
    for (size_t i = 0; i < scene.x.size(); ++i) scene.x[i] = scene.x[i] + scene.dx[i];
  }
}

TEST(PairFinder, FindsOnlyPairsOfNewPositions) {
  Scene scene = two_spheres(2, 0.02);
  PairFinder finder(scene.primitives);
  std::mt19937 random(3);
  for (const int share : {1, 30, 4000}) {  // one of `share` positions is new
    scene.is_new.clear();
    for (size_t i = 0; i < scene.x.size(); ++i) scene.is_new.push_back(random() % share == 0);
    const auto is_known = [&](const auto& points) {
      return std::none_of(points.begin(), points.end(), [&](int p) { return scene.is_new[p]; });
    };
    const SurfacePrimitives& all = scene.primitives;
    ClosePairs expected = brute_force(scene);
    std::erase_if(expected.vertex_triangle,
                  [&](auto& k) { return !scene.is_new[all.vertices[k[0]]] && is_known(all.triangles[k[1]]); });
    std::erase_if(expected.edge_edge, [&](auto& k) { return is_known(all.edges[k[0]]) && is_known(all.edges[k[1]]); });
    expect_equal(find(finder, scene), expected);
  }
}

// A surface that moves and turns as a whole meets itself nowhere, however long its path is.
TEST(PairFinder, PointsThatMoveTogetherAreNoPairs) {
  Scene scene = two_spheres(10, 1);
  scene.dx.assign(scene.x.size(), {});
  PairFinder finder(scene.primitives);
  const ClosePairs at_rest = find(finder, scene);
  for (Vec3d& dx : scene.dx) dx = {{5, -3, 2}};
  expect_equal(find(finder, scene), at_rest);
  for (size_t i = 0; i < scene.x.size(); ++i) scene.dx[i] = scene.dx[i] + 0.1 * cross({{0, 0, 1}}, scene.x[i]);
  EXPECT_LT(find(finder, scene).edge_edge.size(), 2 * at_rest.edge_edge.size());
}

// All triangles that a vertex reaches at one of many times are found.
TEST(PairFinder, FindsWhatComesCloseOnTheWay) {
  const Scene scene = two_spheres(11, 0.3);
  PairFinder finder(scene.primitives);
  const ClosePairs pairs = find(finder, scene, nullptr, 1 << 24);
  const auto& [vertices, edges, triangles] = scene.primitives;
  int close = 0;
  for (const double t : {0.0, 0.11, 0.37, 0.5, 0.73, 1.0}) {
    const auto at = [&](int i) { return scene.x[i] + t * scene.dx[i]; };
    for (int v = 0; v < static_cast<int>(vertices.size()); ++v)
      for (int k = 0; k < static_cast<int>(triangles.size()); ++k) {
        const auto& [a, b, c] = triangles[k];
        const int p = vertices[v];
        if (p == a || p == b || p == c) continue;
        if (pair_distance(PairKind::point_triangle, {at(p), at(a), at(b), at(c)}).d > 0.04) continue;
        ++close;
        EXPECT_TRUE(std::binary_search(pairs.vertex_triangle.begin(), pairs.vertex_triangle.end(), std::array{v, k}));
      }
  }
  EXPECT_GT(close, 100);
}

TEST(PairFinder, AgreesWithBruteForceAfterPositionsAreShuffled) {
  Scene scene = two_spheres(2, 0.01);
  PairFinder finder(scene.primitives);
  find(finder, scene);
  std::shuffle(scene.x.begin(), scene.x.end(), std::mt19937(3));
  expect_equal(find(finder, scene, nullptr, 1 << 24), brute_force(scene));
}

TEST(PairFinder, DoesNotDependOnThreadsOrEarlierQueries) {
  const Scene scene = two_spheres(4, 0.05), other = two_spheres(5, 0.5);
  const int threads = thread_count();
  set_thread_count(1);
  PairFinder fresh(scene.primitives), used(scene.primitives);
  const ClosePairs expected = find(fresh, scene);
  set_thread_count(3);
  find(used, other);
  expect_equal(find(used, scene), expected);
  set_thread_count(threads);
}

TEST(PairFinder, ReportsOverflowWithEmptyLists) {
  const Scene scene = two_spheres(6, 0.01);
  PairFinder finder(scene.primitives);
  const size_t count = std::max(find(finder, scene).vertex_triangle.size(), find(finder, scene).edge_edge.size());
  EXPECT_TRUE(find(finder, scene, nullptr, count).is_complete);
  const ClosePairs overflow = find(finder, scene, nullptr, count - 1);
  EXPECT_FALSE(overflow.is_complete);
  EXPECT_TRUE(overflow.vertex_triangle.empty() && overflow.edge_edge.empty());
}

// Accepts pairs of different surfaces.
class BetweenSurfaces : public PairFilter {
 public:
  explicit BetweenSurfaces(const SurfacePrimitives& primitives)
      : primitives_(primitives), middle_(static_cast<int>(primitives.vertices.size()) / 2) {}
  bool accepts_vertex_triangle(int v, int t) const override {
    return is_second(primitives_.vertices[v]) != is_second(primitives_.triangles[t][0]);
  }
  bool accepts_edge_edge(int a, int b) const override {
    return is_second(primitives_.edges[a][0]) != is_second(primitives_.edges[b][0]);
  }

 private:
  bool is_second(int point) const { return point >= middle_; }
  const SurfacePrimitives& primitives_;
  int middle_;
};

TEST(PairFinder, AppliesFilterOfCaller) {
  const Scene scene = two_spheres(7, 0.02);
  PairFinder finder(scene.primitives);
  const BetweenSurfaces filter(scene.primitives);
  ClosePairs expected = brute_force(scene);
  std::erase_if(expected.vertex_triangle, [&](const auto& p) { return !filter.accepts_vertex_triangle(p[0], p[1]); });
  std::erase_if(expected.edge_edge, [&](const auto& p) { return !filter.accepts_edge_edge(p[0], p[1]); });
  EXPECT_FALSE(expected.vertex_triangle.empty());
  expect_equal(find(finder, scene, &filter), expected);
}

TEST(PairFinder, OmitsPositionsThatAreNotFinite) {
  Scene scene = two_spheres(8, 0.02);
  ClosePairs expected = brute_force(scene);
  const int bad = expected.vertex_triangle[0][0];
  const auto is_touched = [&](const auto& points) {
    return std::find(points.begin(), points.end(), bad) != points.end();
  };
  std::erase_if(expected.vertex_triangle,
                [&](const auto& p) { return p[0] == bad || is_touched(scene.primitives.triangles[p[1]]); });
  std::erase_if(expected.edge_edge, [&](const auto& p) {
    return is_touched(scene.primitives.edges[p[0]]) || is_touched(scene.primitives.edges[p[1]]);
  });
  for (const double value : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    PairFinder finder(scene.primitives);
    scene.x[bad] = {{0, value, 0}};
    expect_equal(find(finder, scene), expected);
  }
}

// Returns the two spheres as two lists; they share the positions.
std::array<SurfacePrimitives, 2> halves(const SurfacePrimitives& all) {
  std::array<SurfacePrimitives, 2> half;
  const int middle = static_cast<int>(all.vertices.size()) / 2;
  for (const int v : all.vertices) half[v >= middle].vertices.push_back(v);
  for (const auto& e : all.edges) half[e[0] >= middle].edges.push_back(e);
  for (const auto& t : all.triangles) half[t[0] >= middle].triangles.push_back(t);
  return half;
}

TEST(PairFinder, FindsPairsBetweenTwoLists) {
  const Scene scene = two_spheres(9, 0.05);
  PairFinder together(scene.primitives);
  const BetweenSurfaces filter(scene.primitives);
  const ClosePairs expected = find(together, scene, &filter);
  const auto half = halves(scene.primitives);
  const int vertices = static_cast<int>(half[0].vertices.size()), edges = static_cast<int>(half[0].edges.size()),
            triangles = static_cast<int>(half[0].triangles.size());
  const PairQuery query{.x = scene.x,
                        .dx = scene.dx,
                        .vertex_radius = std::span(scene.vertex_radius).first(vertices),
                        .edge_radius = std::span(scene.edge_radius).first(edges),
                        .triangle_radius = std::span(scene.triangle_radius).first(triangles)};
  PairFinder a(half[0]), b(half[1]);
  a.place(query);
  b.place(query);
  ClosePairs found = a.find_between(b, true, nullptr, query.limit);
  for (auto& [v, t] : found.vertex_triangle) t += triangles;
  for (auto& [e, f] : found.edge_edge) f += edges;
  for (const auto& [v, t] : b.find_between(a, false, nullptr, query.limit).vertex_triangle)
    found.vertex_triangle.push_back({v + vertices, t});
  expect_equal(found, expected);
  EXPECT_FALSE(a.find_between(b, true, nullptr, 0).is_complete);
}

TEST(PairFinder, AcceptsEmptyLists) {
  PairFinder finder({});
  EXPECT_TRUE(finder.find({}).is_complete);
  PairFinder vertices({{0, 1}, {}, {}});
  const std::vector<Vec3d> x(2);
  EXPECT_TRUE(vertices.find({.x = x}).vertex_triangle.empty());
}

}  // namespace
}  // namespace aspic
