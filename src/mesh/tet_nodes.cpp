#include "mesh/tet_nodes.h"

#include <algorithm>

#include "base/check.h"
#include "mesh/grouped_elements.h"

namespace aspic {
namespace {

// The four corners, and the octahedron between them around its diagonal from edge 0 to edge 5.
constexpr int kParts[8][4] = {{0, 4, 6, 7}, {4, 1, 5, 8}, {6, 5, 2, 9}, {7, 8, 9, 3},
                              {4, 5, 9, 8}, {4, 8, 9, 7}, {4, 7, 9, 6}, {4, 6, 9, 5}};

}  // namespace

TetNodes nodes_of(const TetMesh& mesh, int element) {
  if (element >= mesh.first_segment()) return {{mesh.segment(element)[0], mesh.segment(element)[1]}, 2};
  if (!mesh.is_tet(element)) {
    const auto& [a, b, c] = mesh.triangle(element);
    return {{a, b, c}, 3};
  }
  TetNodes nodes{{}, 4};
  std::copy_n(mesh.tets[element].begin(), 4, nodes.node.begin());
  if (!is_quadratic(mesh, element)) return nodes;
  std::copy_n(mesh.mids[element].begin(), 6, nodes.node.begin() + 4);
  nodes.count = 10;
  return nodes;
}

std::array<double, 10> quadratic_shapes(const std::array<double, 4>& l) {
  std::array<double, 10> N{};
  for (int n = 0; n < 4; ++n) N[n] = l[n] * (2 * l[n] - 1);
  for (int k = 0; k < 6; ++k) N[4 + k] = 4 * l[kTetEdges[k][0]] * l[kTetEdges[k][1]];
  return N;
}

double quadratic_derivative(int n, int i, const std::array<double, 4>& l) {
  if (n < 4) return n == i ? 4 * l[i] - 1 : 0;
  const auto& [a, b] = kTetEdges[n - 4];
  return i == a ? 4 * l[b] : i == b ? 4 * l[a] : 0;
}

TetMesh raise_order(TetMesh mesh) {
  ASPIC_CHECK(mesh.mids.empty());
  const auto edges = grouped_elements<2>(mesh.vertex_count(), [&](const auto& visit) {
    for (int t = 0; t < mesh.tet_count(); ++t)
      for (int k = 0; k < 6; ++k) visit({mesh.tets[t][kTetEdges[k][0]], mesh.tets[t][kTetEdges[k][1]]}, 6 * t + k);
  });
  std::vector<int> first_use(6 * mesh.tets.size());  // the first place of the same edge
  for_each_group(edges, [&](const GroupedElement<2>* begin, const GroupedElement<2>* end) {
    for (const GroupedElement<2>* use = begin; use < end; ++use) first_use[use->place] = begin->place;
  });
  mesh.mids.resize(mesh.tets.size());
  for (int place = 0; place < static_cast<int>(first_use.size()); ++place) {
    const int first = first_use[place];
    int& node = mesh.mids[place / 6][place % 6];
    node = first < place ? mesh.mids[first / 6][first % 6] : mesh.vertex_count();
    if (first == place) mesh.rest.emplace_back();
  }
  straighten_edges(mesh, mesh.rest);
  return mesh;
}

TetMesh lower_order(TetMesh mesh) {
  if (mesh.mids.empty()) return mesh;
  std::vector<int> number(mesh.rest.size(), 0);
  for (const MidNodes& mids : mesh.mids)
    for (const int v : mids)
      if (v >= 0) number[v] = -1;
  for (const Tet& tet : mesh.tets)
    for (const int v : tet) number[v] = 0;
  int count = 0;
  for (size_t v = 0; v < number.size(); ++v) {
    if (number[v] < 0) continue;
    mesh.rest[count] = mesh.rest[v];
    number[v] = count++;
  }
  mesh.rest.resize(count);
  mesh.mids.clear();
  for (Tet& tet : mesh.tets)
    for (int& v : tet) v = number[v];
  return mesh;
}

void straighten_edges(const TetMesh& mesh, std::vector<Vec3d>& positions) {
  for (int t = 0; t < mesh.tet_count(); ++t)
    for (int k = 0; k < 6 && is_quadratic(mesh, t); ++k)
      positions[mesh.mids[t][k]] =
          0.5 * (positions[mesh.tets[t][kTetEdges[k][0]]] + positions[mesh.tets[t][kTetEdges[k][1]]]);
}

// At the centroid dN_n/dl_i is 0 for a corner n, and 1 for the mid-edge nodes of the edges at corner i.
std::array<Vec3d, 4> center_corners(const TetMesh& mesh, int tet, std::span<const double> x) {
  const TetNodes nodes = nodes_of(mesh, tet);
  const auto at = [&](int v) { return Vec3d{{x[3 * v], x[3 * v + 1], x[3 * v + 2]}}; };
  if (nodes.count == 4) return {at(nodes[0]), at(nodes[1]), at(nodes[2]), at(nodes[3])};
  std::array<Vec3d, 4> corners{};
  for (int k = 0; k < 6; ++k)
    for (const int c : kTetEdges[k]) corners[c] = corners[c] + at(nodes[4 + k]);
  return corners;
}

LinearParts linear_parts(const TetMesh& mesh) {
  LinearParts parts;
  parts.mesh.rest = mesh.rest;
  parts.mesh.sheet = mesh.sheet;
  parts.mesh.thickness = mesh.thickness;
  parts.mesh.pattern = mesh.pattern;
  parts.mesh.rods = mesh.rods;
  parts.mesh.radius = mesh.radius;
  const auto add = [&](int t, const Tet& part) {
    parts.mesh.tets.push_back(part);
    parts.tet.push_back(t);
    if (!mesh.region.empty()) parts.mesh.region.push_back(mesh.region[t]);
  };
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const TetNodes nodes = nodes_of(mesh, t);
    if (nodes.count == 4) {
      add(t, mesh.tets[t]);
      continue;
    }
    for (const auto& [a, b, c, d] : kParts) add(t, {nodes[a], nodes[b], nodes[c], nodes[d]});
  }
  return parts;
}

}  // namespace aspic
