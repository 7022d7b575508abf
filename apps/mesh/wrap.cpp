// Watertight rebuilding of defective surfaces, by CGAL's alpha wrapping.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>

#include <array>
#include <cmath>

#include "base/error.h"
#include "mesh/box_tree.h"
#include "mesh/triangle_shape.h"
#include "mesher.h"

namespace aspic {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Surface = CGAL::Surface_mesh<Point>;

struct Soup {
  std::vector<Point> points;
  std::vector<std::array<size_t, 3>> triangles;
  double diagonal = 0;
};

Soup soup_of(const TriMesh& mesh) {
  Soup soup;
  Box box;
  for (const Vec3d& x : mesh.vertices) {
    soup.points.emplace_back(x[0], x[1], x[2]);
    box.add(x);
  }
  for (const auto& [a, b, c] : mesh.triangles)
    if (!is_degenerate({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]}))
      soup.triangles.push_back({static_cast<size_t>(a), static_cast<size_t>(b), static_cast<size_t>(c)});
  const Vec3d extent = box.upper - box.lower;
  soup.diagonal = std::sqrt(dot(extent, extent));
  return soup;
}

struct Wrap {
  Surface surface;
  double volume = 0;
};

Wrap wrapped(const Soup& soup, double alpha) {
  constexpr double kOffset = 0.1;  // of alpha
  Wrap wrap;
  CGAL::alpha_wrap_3(soup.points, soup.triangles, alpha, kOffset * alpha, wrap.surface);
  wrap.volume = CGAL::Polygon_mesh_processing::volume(wrap.surface);
  return wrap;
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

}  // namespace

// Wraps with finer and finer probes, as long as they do not enter the shape through its holes: there the volume drops.
Rebuilt rebuilt(const TriMesh& mesh) {
  constexpr double kCoarsest = 20, kFinest = 160;  // parts of the diagonal
  constexpr double kEntered = 0.65;                // volume of a wrap that went inside, relative to the coarser one
  const Soup soup = soup_of(mesh);
  if (soup.triangles.empty()) throw InvalidInput("--rebuild: no triangle of the surface has an area");
  double parts = kCoarsest;
  Wrap best = wrapped(soup, soup.diagonal / parts);
  while (parts < kFinest) {
    Wrap finer = wrapped(soup, soup.diagonal / (2 * parts));
    if (finer.volume < kEntered * best.volume) break;
    best = std::move(finer);
    parts *= 2;
  }
  return {to_tri_mesh(best.surface), soup.diagonal / parts};
}

}  // namespace aspic
