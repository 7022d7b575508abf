#include "io/quadratic_content.h"

#include <algorithm>
#include <limits>
#include <sstream>
#include <utility>

#include "mesh/tet_nodes.h"

namespace aspic {
namespace {

struct Curvature {
  int mids = 0, curved = 0;
  double distance = 0, relative = 0;  // largest distance from the midpoint of an edge [m], and relative to the edge
};

// Adds a mid-edge node. Formats number the edges of a tet differently, so the node belongs to the nearest one.
void add_mid(const MeshContent& content, const Tet& tet, int node, Curvature& curvature) {
  constexpr double kStraight = 1e-6;  // text files have few digits
  double distance = std::numeric_limits<double>::infinity(), length = 1;
  for (const auto& [i, j] : kTetEdges) {
    const Vec3d &a = content.vertices[tet[i]], &b = content.vertices[tet[j]];
    const double here = norm(content.vertices[node] - 0.5 * (a + b));
    if (here < distance) distance = here, length = norm(b - a);
  }
  ++curvature.mids;
  if (distance <= kStraight * length) return;
  ++curvature.curved;
  curvature.distance = std::max(curvature.distance, distance);
  if (length > 0) curvature.relative = std::max(curvature.relative, distance / length);
}

Curvature curvature_of(const MeshContent& content) {
  Curvature curvature;
  std::vector<char> is_known(content.vertices.size(), 0);
  for (size_t t = 0; t < content.tets.size(); ++t)
    for (const int node : content.mids[t])
      if (node >= 0 && !std::exchange(is_known[node], 1)) add_mid(content, content.tets[t], node, curvature);
  return curvature;
}

// Removes the vertices that are only mid-edge nodes.
void remove_vertices(MeshContent& content) {
  constexpr int kKept = 0, kRemoved = -1;
  std::vector<int> number(content.vertices.size(), kKept);
  for (const MidNodes& mids : content.mids)
    for (const int node : mids)
      if (node >= 0) number[node] = kRemoved;
  const auto for_corners = [&](const auto& act) {
    for (Tet& tet : content.tets) std::for_each(tet.begin(), tet.end(), act);
    for (Triangle& triangle : content.triangles) std::for_each(triangle.begin(), triangle.end(), act);
    for (SurfaceGroup& group : content.groups.surfaces)
      for (Triangle& triangle : group.triangles) std::for_each(triangle.begin(), triangle.end(), act);
  };
  for_corners([&](int& v) { number[v] = kKept; });
  int count = 0;
  for (size_t v = 0; v < number.size(); ++v) {
    if (number[v] == kRemoved) continue;
    number[v] = count;
    content.vertices[count++] = content.vertices[v];
  }
  content.vertices.resize(count);
  for_corners([&](int& v) { v = number[v]; });
  content.mids.clear();
}

}  // namespace

std::string remove_mid_nodes(MeshContent& content) {
  if (content.mids.empty()) return "";
  const Curvature curvature = curvature_of(content);
  remove_vertices(content);
  std::ostringstream note;
  note.precision(2);
  note << "quadratic tets; order = 2 in the body makes them quadratic again, without it they are linear";
  if (curvature.curved > 0)
    note << "; " << curvature.curved << " of " << curvature.mids << " edges are curved and become straight (by at most "
         << curvature.distance << " m, " << 100 * curvature.relative << " % of the edge)";
  return note.str();
}

}  // namespace aspic
