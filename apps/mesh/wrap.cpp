// Rebuilds defective surfaces as watertight ones with CGAL's alpha wrapping.
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/alpha_wrap_3.h>

#include <algorithm>

#include "base/error.h"
#include "mesh/box_tree.h"
#include "mesh/triangle_shape.h"
#include "mesher.h"
#include "surface_mesh.h"
#include "unit_frame.h"

namespace aspic {
namespace {

namespace processing = CGAL::Polygon_mesh_processing;

TriMesh without_degenerate_triangles(TriMesh mesh) {
  std::erase_if(mesh.triangles, [&](const Triangle& triangle) {
    return is_degenerate({mesh.vertices[triangle[0]], mesh.vertices[triangle[1]], mesh.vertices[triangle[2]]});
  });
  return mesh;
}

struct Wrap {
  SurfaceMesh surface;
  double volume = 0;
  double inner = 0;  // volume without the layer between wrap and surface; near 0 for a sheet
};

Wrap wrapped(const Soup& soup, double alpha) {
  constexpr double kOffset = 0.1;  // fraction of alpha
  Wrap wrap;
  CGAL::alpha_wrap_3(soup.points, soup.triangles, alpha, kOffset * alpha, wrap.surface);
  wrap.volume = processing::volume(wrap.surface);
  wrap.inner = wrap.volume - kOffset * alpha * processing::area(wrap.surface);
  return wrap;
}

void check_encloses(const std::string& name, const Wrap& wrap, double least) {
  if (wrap.inner < least * wrap.volume)
    throw InvalidInput(name +
                       ": encloses almost no volume: it is a sheet, or too open for --rebuild; give the "
                       "sheet a thickness, or close the surface, in the source model");
}

}  // namespace

// Wraps with decreasing alpha until the wrap enters the shape through its gaps, where the volume drops.
Rebuilt rebuilt(const std::string& name, const TriMesh& mesh) {
  constexpr double kCoarsest = 20, kFinest = 160;  // fractions of the diagonal
  constexpr double kEntered = 0.65;                // relative inner volume that shows that the wrap went inside
  const TriMesh triangles = without_degenerate_triangles(mesh);
  if (triangles.triangles.empty()) throw InvalidInput(name + ": no triangle has an area; export the surface again");
  const Soup soup = to_soup(with_holes_filled(triangles, Box::kInfinity));
  const double whole = diagonal(mesh.vertices);
  double parts = kCoarsest;
  Wrap best = wrapped(soup, whole / parts);
  check_encloses(name, best, 0.05);
  while (parts < kFinest) {
    Wrap finer = wrapped(soup, whole / (2 * parts));
    if (finer.inner < kEntered * best.inner) break;
    best = std::move(finer);
    parts *= 2;
  }
  check_encloses(name, best, 0.2);
  return {to_tri_mesh(best.surface), whole / parts};
}

}  // namespace aspic
