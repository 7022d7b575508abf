#include "mesh/surface.h"

#include <algorithm>

#include "base/check.h"

namespace aspic {
namespace {

// Corners of the face opposite each corner, counter-clockwise seen from outside a positively oriented tet.
constexpr int kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

struct Face {
  Triangle sorted;  // its vertices in ascending order: the same for both tets that share it
  int place;        // 4 tet + face
};

Triangle corners(const Tet& tet, int face) {
  return {tet[kFaces[face][0]], tet[kFaces[face][1]], tet[kFaces[face][2]]};
}

std::vector<Face> sorted_faces(const TetMesh& mesh, int first, int count) {
  std::vector<Face> faces;
  faces.reserve(4 * static_cast<size_t>(count));
  for (int t = first; t < first + count; ++t) {
    for (int f = 0; f < 4; ++f) {
      Triangle key = corners(mesh.tets[t], f);
      std::sort(key.begin(), key.end());
      faces.push_back({key, 4 * t + f});
    }
  }
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) {
    return a.sorted != b.sorted ? a.sorted < b.sorted : a.place < b.place;
  });
  return faces;
}

}  // namespace

std::vector<Triangle> boundary_triangles(const TetMesh& mesh, int first, int count) {
  ASPIC_CHECK(first >= 0 && count >= 0 && first + count <= mesh.tet_count());
  const std::vector<Face> faces = sorted_faces(mesh, first, count);
  std::vector<int> places;
  for (size_t begin = 0, end; begin < faces.size(); begin = end) {
    for (end = begin + 1; end < faces.size() && faces[end].sorted == faces[begin].sorted;) ++end;
    if (end == begin + 1) places.push_back(faces[begin].place);
  }
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
