#include "dynamics/stiffness_parts.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "mesh/components.h"
#include "mesh/tet_nodes.h"

namespace aspic {
namespace {

// Regions of one body are tested separately if their moduli times edge lengths differ by more than this factor. At the
// default tolerance of 1e-6, a region that is softer by less is resolved to 1e-4 of its own forces, and one whose tets
// are smaller by less to 1e-2, because forces grow with areas.
constexpr double kSoft = 100;

// Gives all nodes of a quadratic tet the stiffness of its stiffest: changes of volume are felt by the mid-edge nodes
// alone.
void share_in_quadratic_tets(const TetMesh& mesh, std::vector<double>& stiffness) {
  const std::vector<double> own = stiffness;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    if (!is_quadratic(mesh, t)) continue;
    double largest = 0;
    for (const int v : nodes_of(mesh, t)) largest = std::max(largest, own[v]);
    for (const int v : nodes_of(mesh, t)) stiffness[v] = std::max(stiffness[v], largest);
  }
}

}  // namespace

std::vector<double> longest_edge(const TetMesh& mesh) {
  std::vector<double> longest(mesh.vertex_count(), 0.0);
  for (const Tet& tet : mesh.tets) {
    double square = 0;
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < a; ++b) square = std::max(square, squared_norm(mesh.rest[tet[a]] - mesh.rest[tet[b]]));
    for (const int v : tet) longest[v] = std::max(longest[v], std::sqrt(square));
  }
  for (const Triangle& triangle : mesh.sheet)
    for (int c = 0; c < 3; ++c) {
      const int a = triangle[c], b = triangle[(c + 1) % 3];
      const double edge = norm(mesh.rest[a] - mesh.rest[b]);
      for (const int v : triangle) longest[v] = std::max(longest[v], edge);
    }
  for (const auto& [a, b] : mesh.rods)
    for (const int v : {a, b}) longest[v] = std::max(longest[v], norm(mesh.rest[a] - mesh.rest[b]));
  return longest;
}

int softness_level(double stiffest, double stiffness) {
  constexpr int kSoftest = 20;
  const double softer = std::log(stiffest / stiffness) / std::log(kSoft);
  return softer > 0 ? static_cast<int>(std::min<double>(softer, kSoftest)) : 0;
}

std::vector<int> parts_of(const TetMesh& mesh, std::span<const double> modulus) {
  std::vector<double> stiffness = longest_edge(linear_parts(mesh).mesh);
  for (int v = 0; v < mesh.vertex_count(); ++v) stiffness[v] *= modulus[v];
  share_in_quadratic_tets(mesh, stiffness);
  const std::vector<std::vector<int>> components = element_components(mesh);
  std::vector<int> component(mesh.vertex_count(), 0);
  std::vector<double> stiffest(components.size() + 1, 0.0);
  for (size_t c = 0; c < components.size(); ++c)
    for (const int t : components[c])
      for (const int v : nodes_of(mesh, t)) component[v] = static_cast<int>(c);
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (std::isfinite(stiffness[v])) stiffest[component[v]] = std::max(stiffest[component[v]], stiffness[v]);
  std::map<std::pair<int, int>, int> number;
  std::vector<int> part(mesh.vertex_count());
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const int level = softness_level(stiffest[component[v]], stiffness[v]);
    part[v] = number.try_emplace({component[v], level}, static_cast<int>(number.size())).first->second;
  }
  return part;
}

}  // namespace aspic
