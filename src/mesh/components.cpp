#include "mesh/components.h"

#include <cstddef>

#include "mesh/disjoint_sets.h"

namespace aspic {
namespace {

template <class Element>
std::vector<std::vector<int>> components(int vertices, const std::vector<Element>& elements) {
  DisjointSets sets(vertices);
  for (const Element& element : elements)
    for (int v : element) sets.join(element[0], v);
  std::vector<int> component(vertices, -1);
  std::vector<std::vector<int>> members;
  for (size_t e = 0; e < elements.size(); ++e) {
    int& number = component[sets.find(elements[e][0])];
    if (number < 0) {
      number = static_cast<int>(members.size());
      members.emplace_back();
    }
    members[number].push_back(static_cast<int>(e));
  }
  return members;
}

}  // namespace

std::vector<std::vector<int>> tet_components(const TetMesh& mesh) { return components(mesh.vertex_count(), mesh.tets); }

std::vector<std::vector<int>> element_components(const TetMesh& mesh) {
  if (mesh.element_count() == mesh.tet_count()) return tet_components(mesh);
  std::vector<std::vector<int>> corners;
  for (const Tet& tet : mesh.tets) corners.emplace_back(tet.begin(), tet.end());
  for (const Triangle& triangle : mesh.sheet) corners.emplace_back(triangle.begin(), triangle.end());
  for (const Segment& segment : mesh.rods) corners.emplace_back(segment.begin(), segment.end());
  return components(mesh.vertex_count(), corners);
}

std::vector<std::vector<int>> triangle_components(const TriMesh& mesh) {
  return components(mesh.vertex_count(), mesh.triangles);
}

}  // namespace aspic
