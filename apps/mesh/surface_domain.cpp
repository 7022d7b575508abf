#include <CGAL/Mesh_domain_with_polyline_features_3.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Polyhedral_mesh_domain_3.h>

#include "body_domain.h"
#include "mesh3.h"
#include "surface_mesh.h"

namespace aspic {
namespace {

namespace processing = CGAL::Polygon_mesh_processing;
using Domain = CGAL::Mesh_domain_with_polyline_features_3<CGAL::Polyhedral_mesh_domain_3<SurfaceMesh, Kernel>>;

SurfaceMesh to_surface(const TriMesh& mesh) {
  Soup soup = to_soup(mesh);
  processing::orient_polygon_soup(soup.points, soup.triangles);
  SurfaceMesh surface;
  processing::polygon_soup_to_polygon_mesh(soup.points, soup.triangles, surface);
  return surface;
}

class BodySize {
 public:
  using Index = Domain::Index;

  explicit BodySize(const LocalSize& size) : size_(&size) {}
  double operator()(const Point& x, int, const Index&) const { return (*size_)({{x.x(), x.y(), x.z()}}); }

 private:
  const LocalSize* size_;
};

std::vector<std::vector<Point>> polylines(const std::vector<std::vector<Vec3d>>& chains) {
  std::vector<std::vector<Point>> lines;
  for (const std::vector<Vec3d>& chain : chains) {
    std::vector<Point>& line = lines.emplace_back();
    for (const Vec3d& x : chain) line.emplace_back(x[0], x[1], x[2]);
  }
  return lines;
}

Seeds<Domain> seeds(const Domain& domain, const std::vector<Vec3d>& points) {
  std::vector<std::pair<Point, Domain::Index>> shot;  // for the index of the surface
  domain.construct_initial_points_object()(std::back_inserter(shot), 1);
  Seeds<Domain> seeds;
  for (const Vec3d& x : points) seeds.emplace_back(Point(x[0], x[1], x[2]), shot.front().second);
  return seeds;
}

}  // namespace

TetMesh fill_body(const BodyDomain& body) {
  const SurfaceMesh surface = to_surface(body.surface);
  Domain domain(surface);
  const std::vector<std::vector<Point>> lines = polylines(body.sharp);
  domain.add_features(lines.begin(), lines.end());
  bool is_complete = false;  // an incomplete mesh is checked like any other
  const BodySize edge(body.size);
  const Seeds<Domain> starts = seeds(domain, body.seeds);
  TetMesh tets =
      filled(Filling<Domain, BodySize>{domain, edge, starts, body.most_vertices, !body.has_blade}, is_complete);
  tets.region.clear();
  return tets;
}

TriMesh with_holes_filled(const TriMesh& mesh, double longest) {
  SurfaceMesh surface = to_surface(mesh);
  std::vector<SurfaceMesh::Halfedge_index> borders;
  processing::extract_boundary_cycles(surface, std::back_inserter(borders));
  for (const auto border : borders) {
    if (processing::face_border_length(border, surface) > longest) continue;
    std::vector<SurfaceMesh::Face_index> faces;
    processing::triangulate_hole(surface, border, std::back_inserter(faces));
  }
  return to_tri_mesh(surface);
}

}  // namespace aspic
