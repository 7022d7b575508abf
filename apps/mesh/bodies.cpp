#include "bodies.h"

#include <algorithm>

#include "mesh/components.h"
#include "mesh/disjoint_sets.h"
#include "mesh/surface_orientation.h"
#include "mesh/topology.h"
#include "triangle_tree.h"

namespace aspic {
namespace {

TriMesh part(const TriMesh& mesh, const std::vector<int>& triangles) {
  TriMesh result;
  std::vector<int> number(mesh.vertices.size(), -1);
  for (int t : triangles) {
    Triangle triangle = mesh.triangles[t];
    for (int& v : triangle) {
      if (number[v] < 0) {
        number[v] = result.vertex_count();
        result.vertices.push_back(mesh.vertices[v]);
      }
      v = number[v];
    }
    result.triangles.push_back(triangle);
  }
  return result;
}

void append(const TriMesh& part, TriMesh& whole) {
  const int first = whole.vertex_count();
  whole.vertices.insert(whole.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (const auto& [a, b, c] : part.triangles) whole.triangles.push_back({first + a, first + b, first + c});
}

void make_face(TriMesh& shell, bool outward) {
  if ((enclosed_volume(shell) > 0) == outward) return;
  for (Triangle& triangle : shell.triangles) std::swap(triangle[1], triangle[2]);
}

Box box_of(const TriMesh& mesh) {
  Box box;
  for (const Vec3d& x : mesh.vertices) box.add(x);
  return box;
}

// For each shell, the shells that contain it.
std::vector<std::vector<int>> around(const std::vector<TriMesh>& shells) {
  std::vector<Box> boxes;
  for (const TriMesh& shell : shells) boxes.push_back(box_of(shell));
  const BoxTree tree(boxes);
  std::vector<std::vector<int>> around(shells.size());
  for (int outer = 0; outer < static_cast<int>(shells.size()); ++outer) {
    std::vector<int> candidates;
    tree.for_each_overlap(boxes[outer], [&](int inner) {
      if (inner != outer && boxes[outer].contains(boxes[inner].lower) && boxes[outer].contains(boxes[inner].upper))
        candidates.push_back(inner);
      return true;
    });
    if (candidates.empty()) continue;
    const TriangleTree triangles(shells[outer]);
    for (int inner : candidates)
      if (triangles.contains(shells[inner].vertices[0])) around[inner].push_back(outer);
  }
  return around;
}

}  // namespace

std::vector<TriMesh> bodies(const TriMesh& surface) {
  std::vector<TriMesh> shells;
  for (const std::vector<int>& triangles : triangle_components(surface)) shells.push_back(part(surface, triangles));
  const std::vector<std::vector<int>> outer = around(shells);
  std::vector<int> body(shells.size(), -1);
  std::vector<TriMesh> bodies;
  for (size_t s = 0; s < shells.size(); ++s) {
    make_face(shells[s], outer[s].size() % 2 == 0);
    if (outer[s].size() % 2 == 1) continue;
    body[s] = static_cast<int>(bodies.size());
    bodies.push_back(shells[s]);
  }
  const auto shallower = [&](int a, int b) { return outer[a].size() < outer[b].size(); };
  for (size_t s = 0; s < shells.size(); ++s) {
    if (body[s] >= 0) continue;
    const int owner = body[*std::max_element(outer[s].begin(), outer[s].end(), shallower)];
    if (owner >= 0) append(shells[s], bodies[owner]);
  }
  return bodies;
}

int edge_connected_parts(const std::vector<Triangle>& triangles) {
  DisjointSets sets(static_cast<int>(triangles.size()));
  int parts = static_cast<int>(triangles.size());
  for_each_edge(edge_uses(triangles), [&](const EdgeUse* first, const EdgeUse* last) {
    for (const EdgeUse* use = first + 1; use < last; ++use) {
      if (sets.find(first->triangle) == sets.find(use->triangle)) continue;
      sets.join(first->triangle, use->triangle);
      --parts;
    }
  });
  return parts;
}

}  // namespace aspic
