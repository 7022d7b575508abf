#include "mesh/surface_orientation.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "mesh/topology.h"

namespace aspic {
namespace {

// Neighbors across edges shared by exactly two triangles, and whether their orientations agree.
struct Neighbor {
  int triangle;
  bool agrees;
};

std::vector<std::array<Neighbor, 3>> neighbors(const std::vector<Triangle>& triangles) {
  std::vector<std::array<Neighbor, 3>> list(triangles.size(), {{{-1, true}, {-1, true}, {-1, true}}});
  std::vector<int> known(triangles.size(), 0);
  for_each_edge(edge_uses(triangles), [&](const EdgeUse* first, const EdgeUse* last) {
    if (last - first != 2) return;
    const int a = first[0].triangle, b = first[1].triangle;
    const bool agrees = first[0].forward != first[1].forward;
    list[a][known[a]++] = {b, agrees};
    list[b][known[b]++] = {a, agrees};
  });
  return list;
}

void turn(Triangle& triangle) { std::swap(triangle[1], triangle[2]); }

// Returns the triangles connected to `start` by shared edges. `flip` marks those that must flip to agree with it.
// Returns nothing if the sheet is not orientable (Moebius strip).
std::vector<int> sheet(const std::vector<std::array<Neighbor, 3>>& next, int start, std::vector<int>& flip) {
  std::vector<int> reached = {start};
  flip[start] = 0;
  bool is_orientable = true;
  for (size_t i = 0; i < reached.size(); ++i) {
    for (const auto& [other, agrees] : next[reached[i]]) {
      if (other < 0) continue;
      const int wanted = flip[reached[i]] ^ (agrees ? 0 : 1);
      if (flip[other] < 0) {
        flip[other] = wanted;
        reached.push_back(other);
      } else if (flip[other] != wanted) {
        is_orientable = false;
      }
    }
  }
  if (!is_orientable)
    for (int t : reached) flip[t] = 0;
  return is_orientable ? reached : std::vector<int>{};
}

}  // namespace

double enclosed_volume(const TriMesh& mesh) {
  double sum = 0;
  if (mesh.triangles.empty()) return sum;
  const Vec3d& origin = mesh.vertices[mesh.triangles[0][0]];
  for (const auto& [a, b, c] : mesh.triangles)
    sum += dot(mesh.vertices[a] - origin, cross(mesh.vertices[b] - origin, mesh.vertices[c] - origin)) / 6;
  return sum;
}

size_t orient(TriMesh& mesh) {
  const auto next = neighbors(mesh.triangles);
  std::vector<int> flip(mesh.triangles.size(), -1);
  size_t turned = 0, sheets = 0;
  for (int start = 0; start < mesh.triangle_count(); ++start) {
    if (flip[start] >= 0) continue;
    ++sheets;
    const std::vector<int> triangles = sheet(next, start, flip);
    const auto flipped = std::count_if(triangles.begin(), triangles.end(), [&](int t) { return flip[t] == 1; });
    const int fewer = 2 * static_cast<size_t>(flipped) > triangles.size() ? 0 : 1;
    for (int t : triangles)
      if (flip[t] == fewer) turn(mesh.triangles[t]), ++turned;
  }
  const bool is_closed = std::all_of(next.begin(), next.end(), [](const auto& n) { return n[2].triangle >= 0; });
  if (sheets != 1 || !is_closed || enclosed_volume(mesh) >= 0) return turned;
  for (Triangle& triangle : mesh.triangles) turn(triangle);
  return mesh.triangles.size() - turned;
}

}  // namespace aspic
