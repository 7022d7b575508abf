#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Polyhedral_mesh_domain_3.h>
#include <CGAL/Surface_mesh.h>

#include <cmath>
#include <numeric>

#include "mesh/components.h"
#include "mesh3.h"

namespace aspic {
namespace {

namespace processing = CGAL::Polygon_mesh_processing;
using Surface = CGAL::Surface_mesh<Point>;
using Domain = CGAL::Polyhedral_mesh_domain_3<Surface, Kernel>;

Surface to_surface(const TriMesh& mesh) {
  std::vector<Point> points;
  std::vector<std::array<size_t, 3>> triangles;
  for (const Vec3d& x : mesh.vertices) points.emplace_back(x[0], x[1], x[2]);
  for (const auto& [a, b, c] : mesh.triangles)
    triangles.push_back({static_cast<size_t>(a), static_cast<size_t>(b), static_cast<size_t>(c)});
  processing::orient_polygon_soup(points, triangles);
  Surface surface;
  processing::polygon_soup_to_polygon_mesh(points, triangles, surface);
  return surface;
}

TriMesh to_tri_mesh(const Surface& surface) {
  TriMesh mesh;
  for (const auto vertex : surface.vertices()) {
    const Point& x = surface.point(vertex);
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

CGAL::Bbox_3 bounding_box(const TriMesh& mesh) {
  CGAL::Bbox_3 box;
  for (const Vec3d& x : mesh.vertices) box += Point(x[0], x[1], x[2]).bbox();
  return box;
}

double diagonal(const CGAL::Bbox_3& box) { return std::hypot(box.x_span(), box.y_span(), box.z_span()); }

// Up to a dozen vertices of each component, beside the points that the domain shoots itself.
SeededDomain<Domain>::Seeds seeds(const Domain& domain, const TriMesh& mesh) {
  constexpr size_t kSeedsPerComponent = 12;
  SeededDomain<Domain>::Seeds seeds;
  domain.construct_initial_points_object()(std::back_inserter(seeds));
  const Domain::Index index = seeds.front().second;
  for (const std::vector<int>& triangles : triangle_components(mesh)) {
    const size_t count = std::min(kSeedsPerComponent, triangles.size());
    for (size_t i = 0; i < count; ++i) {
      const Vec3d& x = mesh.vertices[mesh.triangles[triangles[i * triangles.size() / count]][0]];
      seeds.emplace_back(Point(x[0], x[1], x[2]), index);
    }
  }
  return seeds;
}

}  // namespace

TetMesh mesh_surface(const TriMesh& mesh, const MesherOptions& options) {
  const CGAL::Bbox_3 box = bounding_box(mesh);
  const double size = options.size > 0 ? options.size : diagonal(box) / 25;
  check_size(box, size);
  const Surface surface = to_surface(mesh);
  SeededDomain<Domain> domain(surface);
  domain.set_seeds(seeds(domain, mesh));
  TetMesh tets = filled(domain, size, {});
  tets.region.clear();
  return tets;
}

TriMesh with_holes_filled(const TriMesh& mesh) {
  Surface surface = to_surface(mesh);
  const double longest = diagonal(bounding_box(mesh));
  std::vector<Surface::Halfedge_index> borders;
  processing::extract_boundary_cycles(surface, std::back_inserter(borders));
  for (const auto border : borders) {
    if (processing::face_border_length(border, surface) > longest) continue;
    std::vector<Surface::Face_index> faces;
    processing::triangulate_hole(surface, border, std::back_inserter(faces));
  }
  return to_tri_mesh(surface);
}

}  // namespace aspic
