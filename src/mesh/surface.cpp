#include "mesh/surface.h"

#include <algorithm>
#include <set>

#include "base/check.h"
#include "mesh/grouped_elements.h"
#include "mesh/tet_nodes.h"
#include "mesh/tet_shape.h"

namespace aspic {
namespace {

Triangle corners(const Tet& tet, int face) {
  return {tet[kTetFaces[face][0]], tet[kTetFaces[face][1]], tet[kTetFaces[face][2]]};
}

void append_triangles(const Face& face, std::vector<Triangle>& triangles) {
  const auto& [a, b, c] = face.corners;
  const auto& [ab, bc, ca] = face.mids;
  if (face.is_quadratic())
    triangles.insert(triangles.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  else
    triangles.push_back(face.corners);
}

int edge_between(int a, int b) {
  for (int k = 0; k < 6; ++k)
    if (std::minmax(kTetEdges[k][0], kTetEdges[k][1]) == std::minmax(a, b)) return k;
  return -1;
}

Face face_of(const TetMesh& mesh, int tet, int face) {
  Face result{corners(mesh.tets[tet], face)};
  if (!is_quadratic(mesh, tet)) return result;
  for (int c = 0; c < 3; ++c)
    result.mids[c] = mesh.mids[tet][edge_between(kTetFaces[face][c], kTetFaces[face][(c + 1) % 3])];
  return result;
}

}  // namespace

std::vector<Face> linear_faces(std::span<const Triangle> triangles) {
  std::vector<Face> faces;
  for (const Triangle& triangle : triangles) faces.push_back({triangle});
  return faces;
}

std::vector<Face> boundary_faces(const TetMesh& mesh, int first, int count) {
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
  std::vector<Face> boundary;
  boundary.reserve(places.size());
  for (int place : places) boundary.push_back(face_of(mesh, place / 4, place % 4));
  return boundary;
}

std::vector<Face> surface_faces(const TetMesh& mesh) {
  std::vector<Face> faces = boundary_faces(mesh, 0, mesh.tet_count());
  for (const Triangle& triangle : mesh.sheet) faces.push_back({triangle});
  return faces;
}

std::vector<Face> faces_of(const TetMesh& mesh, std::span<const Triangle> triangles) {
  if (mesh.mids.empty()) return linear_faces(triangles);
  const auto from_least = [](Triangle t) {
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
  };
  std::set<Triangle> left;
  for (const Triangle& t : triangles) left.insert(from_least(t));
  std::vector<Face> faces;
  for (const Face& face : boundary_faces(mesh, 0, mesh.tet_count())) {
    std::vector<Triangle> parts;
    append_triangles(face, parts);
    const auto is_left = [&](const Triangle& t) { return left.count(from_least(t)) > 0; };
    if (!std::all_of(parts.begin(), parts.end(), is_left)) continue;
    for (const Triangle& t : parts) left.erase(from_least(t));
    faces.push_back(face);
  }
  for (const Triangle& t : left) faces.push_back({t});
  return faces;
}

std::vector<Triangle> boundary_triangles(const TetMesh& mesh, int first, int count) {
  const std::vector<Face> faces = boundary_faces(mesh, first, count);
  std::vector<Triangle> triangles;
  triangles.reserve(faces.size());
  for (const Face& face : faces) append_triangles(face, triangles);
  return triangles;
}

BoundarySurface boundary_surface(const TetMesh& mesh) {
  BoundarySurface boundary;
  boundary.surface.triangles = boundary_triangles(mesh, 0, mesh.tet_count());
  boundary.surface.triangles.insert(boundary.surface.triangles.end(), mesh.sheet.begin(), mesh.sheet.end());
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
