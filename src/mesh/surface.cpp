#include "mesh/surface.h"

#include <algorithm>

#include "base/check.h"
#include "mesh/grouped_elements.h"
#include "mesh/tet_shape.h"

namespace aspic {
namespace {

Triangle corners(const Tet& tet, int face) {
  return {tet[kTetFaces[face][0]], tet[kTetFaces[face][1]], tet[kTetFaces[face][2]]};
}

}  // namespace

std::vector<Triangle> boundary_triangles(const TetMesh& mesh, int first, int count) {
  ASPIC_CHECK(first >= 0 && count >= 0 && first + count <= mesh.tet_count());
  const auto faces = grouped_elements<3>(mesh.vertex_count(), [&](const auto& visit) {
    for (int t = first; t < first + count; ++t)
      for (int f = 0; f < 4; ++f) visit(corners(mesh.tets[t], f), 4 * t + f);
  });
  std::vector<int> places;
  for_each_group(faces, [&](const GroupedElement<3>* begin, const GroupedElement<3>* end) {
    if (end == begin + 1) places.push_back(begin->place);
  });
  std::sort(places.begin(), places.end());  // in the order of the tets
  std::vector<Triangle> triangles;
  triangles.reserve(places.size());
  for (int place : places) triangles.push_back(corners(mesh.tets[place / 4], place % 4));
  return triangles;
}

BoundarySurface boundary_surface(const TetMesh& mesh) {
  BoundarySurface boundary;
  boundary.surface.triangles = boundary_triangles(mesh, 0, mesh.tet_count());
  std::vector<int> surface_vertex(mesh.rest.size(), -1);
  for (const Triangle& triangle : boundary.surface.triangles)
    for (int v : triangle) surface_vertex[v] = 0;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (surface_vertex[v] < 0) continue;
    surface_vertex[v] = boundary.surface.vertex_count();
    boundary.surface.vertices.push_back(mesh.rest[v]);
    boundary.tet_vertex.push_back(v);
  }
  for (Triangle& triangle : boundary.surface.triangles)
    for (int& v : triangle) v = surface_vertex[v];
  return boundary;
}

}  // namespace aspic
