// Conversion of triangles to and from CGAL.
#pragma once
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

#include <array>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

using SurfacePoint = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
using SurfaceMesh = CGAL::Surface_mesh<SurfacePoint>;

struct Soup {
  std::vector<SurfacePoint> points;
  std::vector<std::array<size_t, 3>> triangles;
};

inline Soup to_soup(const TriMesh& mesh) {
  Soup soup;
  for (const Vec3d& x : mesh.vertices) soup.points.emplace_back(x[0], x[1], x[2]);
  for (const auto& [a, b, c] : mesh.triangles)
    soup.triangles.push_back({static_cast<size_t>(a), static_cast<size_t>(b), static_cast<size_t>(c)});
  return soup;
}

inline TriMesh to_tri_mesh(const SurfaceMesh& surface) {
  TriMesh mesh;
  for (const auto vertex : surface.vertices()) {
    const SurfacePoint& x = surface.point(vertex);
    mesh.vertices.push_back({{x.x(), x.y(), x.z()}});
  }
  for (const auto face : surface.faces()) {
    Triangle triangle{};
    int corner = 0;
    for (const auto vertex : CGAL::vertices_around_face(surface.halfedge(face), surface))
      triangle[corner++] = static_cast<int>(vertex.idx());
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

}  // namespace aspic
