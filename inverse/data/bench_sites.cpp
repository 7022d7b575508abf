#include "data/bench_sites.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "mesh/embed.h"

namespace aspic {
namespace {

// Per marker; markers are the candidates that are farthest from each other. Chosen.
constexpr int kCandidates = 20;

double triangle_area(const TetMesh& mesh, const Triangle& t) {
  const Vec3d n = cross(mesh.rest[t[1]] - mesh.rest[t[0]], mesh.rest[t[2]] - mesh.rest[t[0]]);
  return 0.5 * norm(n);
}

// Points distributed evenly over the triangles that are not held.
std::vector<Vec3d> random_points(const TetMesh& mesh, const std::vector<Triangle>& triangles,
                                 std::span<const int> fixed, int count, uint64_t seed) {
  std::vector<char> is_fixed(mesh.rest.size(), 0);
  for (const int v : fixed) is_fixed[v] = 1;
  std::vector<double> area;
  for (const Triangle& t : triangles) {
    const bool is_held = std::all_of(t.begin(), t.end(), [&](int v) { return is_fixed[v] != 0; });
    area.push_back(is_held ? 0 : triangle_area(mesh, t));
  }
  std::vector<Vec3d> points;
  if (std::all_of(area.begin(), area.end(), [](double a) { return a == 0; })) return points;
  std::mt19937_64 random(seed);
  std::discrete_distribution<int> choose(area.begin(), area.end());
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int i = 0; i < count; ++i) {
    const Triangle& t = triangles[choose(random)];
    const double s = std::sqrt(uniform(random)), r = uniform(random);
    points.push_back((1 - s) * mesh.rest[t[0]] + (s * (1 - r)) * mesh.rest[t[1]] + (s * r) * mesh.rest[t[2]]);
  }
  return points;
}

}  // namespace

std::vector<ProjectedPoint> marker_sites(const TetMesh& mesh, const SurfaceProjection& surface,
                                         std::span<const int> fixed, int count, uint64_t seed) {
  const std::vector<Vec3d> points = random_points(mesh, surface.triangles(), fixed, kCandidates * count, seed);
  std::vector<ProjectedPoint> chosen;
  if (points.empty()) return chosen;
  std::vector<double> distance(points.size(), std::numeric_limits<double>::infinity());
  for (size_t next = 0; static_cast<int>(chosen.size()) < count && distance[next] > 0;) {
    chosen.push_back(surface.nearest(points[next]));
    for (size_t i = 0; i < points.size(); ++i) {
      const Vec3d d = points[i] - points[next];
      distance[i] = std::min(distance[i], dot(d, d));
    }
    next = std::max_element(distance.begin(), distance.end()) - distance.begin();
  }
  return chosen;
}

std::vector<int> held_vertices(const TetMesh& truth, std::span<const int> held, const TetMesh& mesh) {
  std::vector<char> is_held(truth.rest.size(), 0);
  for (const int v : held) is_held[v] = 1;
  const Embedding where = embed(truth, {mesh.rest, {}});
  std::vector<int> vertices;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    double share = 0;  // share of the nodes that carry the vertex
    const Carrier& carrier = where.carriers[v];
    for (int n = 0; n < carrier.count; ++n) share += is_held[carrier.vertex[n]] ? carrier.weight[n] : 0;
    if (share > 0.99) vertices.push_back(v);
  }
  return vertices;
}

}  // namespace aspic
