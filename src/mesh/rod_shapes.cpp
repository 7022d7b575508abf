#include "mesh/rod_shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "base/error.h"

namespace aspic {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

template <class At>
TetMesh polyline(int segments, bool is_closed, const At& at) {
  TetMesh mesh;
  for (int i = 0; i < segments + (is_closed ? 0 : 1); ++i) mesh.rest.push_back(at(static_cast<double>(i) / segments));
  const int n = mesh.vertex_count();
  for (int i = 0; i < segments; ++i) mesh.rods.push_back({i, (i + 1) % n});
  return mesh;
}

double helix_length(double radius, double pitch, double turns) { return turns * std::hypot(kTurn * radius, pitch); }

}  // namespace

double segments_in_line(double length, double size) { return std::max(1.0, std::round(length / size)); }
double segments_in_ring(double radius, double size) { return std::max(3.0, std::round(kTurn * radius / size)); }

TetMesh make_line(const Vec3d& from, const Vec3d& to, double size) {
  const int n = static_cast<int>(segments_in_line(norm(to - from), size));
  return polyline(n, false, [&](double s) { return (1 - s) * from + s * to; });
}

TetMesh make_ring(double radius, double size) {
  const int n = static_cast<int>(segments_in_ring(radius, size));
  return polyline(n, true, [&](double s) {
    return Vec3d{{radius * std::cos(kTurn * s), radius * std::sin(kTurn * s), 0}};
  });
}

TetMesh make_helix(double radius, double pitch, double turns, double size) {
  const int n = static_cast<int>(segments_in_line(helix_length(radius, pitch, turns), size));
  return polyline(n, false, [&](double s) {
    const double angle = kTurn * turns * s;
    return Vec3d{{radius * std::cos(angle), radius * std::sin(angle), pitch * turns * s}};
  });
}

std::vector<Segment> chained(int vertex_count, const std::vector<Segment>& segments) {
  std::vector<std::vector<int>> at(vertex_count);
  for (size_t s = 0; s < segments.size(); ++s) {
    const auto& [a, b] = segments[s];
    if (a == b)
      throw InvalidInput("segment " + std::to_string(s) + " leads from vertex " + std::to_string(a) +
                         " to itself; remove it");
    for (const int v : {a, b}) {
      at[v].push_back(static_cast<int>(s));
      if (at[v].size() > 2)
        throw InvalidInput("more than two segments meet at vertex " + std::to_string(v) +
                           "; a rod has no branches (make them other bodies)");
    }
  }
  std::vector<char> is_used(segments.size(), 0);
  std::vector<Segment> result;
  const auto follow = [&](int s, int from) {
    const size_t first = result.size();
    while (s >= 0) {
      is_used[s] = 1;
      const int to = segments[s][0] == from ? segments[s][1] : segments[s][0];
      result.push_back({from, to});
      s = -1;
      for (const int next : at[to])
        if (!is_used[next]) s = next;
      from = to;
    }
    if (result[first][0] == from && result.size() - first < 3)
      throw InvalidInput("two segments join the vertices " + std::to_string(result[first][0]) + " and " +
                         std::to_string(result[first][1]) + "; remove one");
  };
  for (const int end : {0, 1})  // first from ends at which a segment starts
    for (size_t s = 0; s < segments.size(); ++s)
      if (const int v = segments[s][end]; !is_used[s] && at[v].size() == 1) follow(static_cast<int>(s), v);
  for (size_t s = 0; s < segments.size(); ++s)
    if (!is_used[s]) follow(static_cast<int>(s), segments[s][0]);
  return result;
}

}  // namespace aspic
