// Topology of triangle meshes: edges, boundaries and non-manifold features. All lists are ascending.
#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

// For each point, returns the first one at exactly the same position (itself unless duplicate). O(n log n).
std::vector<int> first_at_same_place(const std::vector<Vec3d>& points);

// Use of an edge by one triangle.
struct EdgeUse {
  std::array<int, 2> edge;  // ascending
  int triangle;
  bool forward;  // the triangle traverses it from edge[0] to edge[1]
};
// Returns the uses sorted by edge. Omits triangles that list a vertex twice.
std::vector<EdgeUse> edge_uses(const std::vector<Triangle>& triangles);

// Calls visit(begin, end) for the uses of each edge.
template <class Visit>
void for_each_edge(const std::vector<EdgeUse>& uses, Visit visit) {
  for (size_t begin = 0, end; begin < uses.size(); begin = end) {
    for (end = begin + 1; end < uses.size() && uses[end].edge == uses[begin].edge;) ++end;
    visit(uses.data() + begin, uses.data() + end);
  }
}

struct SurfaceTopology {
  std::vector<int> open;                   // triangles with an edge that no other triangle shares
  std::vector<int> non_manifold;           // triangles with an edge that more than two triangles share
  std::vector<int> disagreeing;            // triangles whose neighbor traverses the common edge in the same direction
  std::vector<int> non_manifold_vertices;  // vertices whose triangles form several fans
  int open_edges = 0, non_manifold_edges = 0;
  int holes = 0;  // connected groups of open edges
};
SurfaceTopology topology(const std::vector<Triangle>& triangles, int vertex_count);

// Returns the elements whose vertices all occur in one earlier element, in any order.
template <class Element>
std::vector<int> repeated_elements(const std::vector<Element>& elements);

template <class Element>
bool lists_vertex_twice(const Element& element) {
  for (size_t i = 0; i < element.size(); ++i)
    for (size_t j = 0; j < i; ++j)
      if (element[i] == element[j]) return true;
  return false;
}

}  // namespace aspic
