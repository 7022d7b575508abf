#include <CGAL/Mesh_domain_with_polyline_features_3.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Polyhedral_mesh_domain_3.h>
#include <CGAL/Surface_mesh.h>

#include <cmath>

#include "body_domain.h"
#include "mesh3.h"

namespace aspic {
namespace {

namespace processing = CGAL::Polygon_mesh_processing;
using Surface = CGAL::Surface_mesh<Point>;
using Domain = CGAL::Mesh_domain_with_polyline_features_3<CGAL::Polyhedral_mesh_domain_3<Surface, Kernel>>;

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

double diagonal(const TriMesh& mesh) {
  CGAL::Bbox_3 box;
  for (const Vec3d& x : mesh.vertices) box += Point(x[0], x[1], x[2]).bbox();
  return std::hypot(box.x_span(), box.y_span(), box.z_span());
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
  const Surface surface = to_surface(body.surface);
  Domain domain(surface);
  const std::vector<std::vector<Point>> lines = polylines(body.sharp);
  domain.add_features(lines.begin(), lines.end());
  bool is_complete = false;  // an incomplete mesh is judged like any other
  TetMesh tets = filled(domain, BodySize(body.size), seeds(domain, body.seeds), body.most_vertices, is_complete);
  tets.region.clear();
  return tets;
}

TriMesh with_holes_filled(const TriMesh& mesh) {
  Surface surface = to_surface(mesh);
  const double longest = diagonal(mesh);
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
