#include <cmath>

#include "labelled.h"
#include "scene/expression.h"

namespace aspic {
namespace {

CGAL::Bbox_3 bounding_box(const Vec3d& lower, const Vec3d& upper) {
  for (int axis = 0; axis < 3; ++axis)
    if (!(lower[axis] < upper[axis]) || !std::isfinite(upper[axis] - lower[axis]))
      throw InvalidInput("--bounds: needs x0 < x1, y0 < y1 and z0 < z1, given as x0 y0 z0 x1 y1 z1");
  return {lower[0], lower[1], lower[2], upper[0], upper[1], upper[2]};
}

CGAL::Bbox_3 widened(const CGAL::Bbox_3& box, double by) {
  return {box.xmin() - by, box.ymin() - by, box.zmin() - by, box.xmax() + by, box.ymax() + by, box.zmax() + by};
}

bool contains(const CGAL::Bbox_3& box, const Point& p) {
  for (int axis = 0; axis < 3; ++axis)
    if (!(p[axis] > box.min(axis) && p[axis] < box.max(axis))) return false;
  return true;
}

Expression parsed(const std::string& text) {
  try {
    return Expression(text);
  } catch (const InvalidInput& error) {
    throw InvalidInput("--implicit: " + std::string(error.what()) +
                       "; write a formula of x, y, z that is negative inside, such as x^2+y^2+z^2-1");
  }
}

}  // namespace

// A shape that reaches beyond the bounds is cut off there.
TetMesh mesh_implicit(const ImplicitShape& shape, const MesherOptions& options) {
  const CGAL::Bbox_3 bounds = bounding_box(shape.lower, shape.upper);
  const double diagonal = std::hypot(bounds.x_span(), bounds.y_span(), bounds.z_span());
  const double size = options.size > 0 ? options.size : diagonal / 25;
  check_size(bounds, size);
  const Expression f = parsed(shape.expression);
  const auto label = [&](const Point& p) { return contains(bounds, p) && f.at({{p.x(), p.y(), p.z()}}) < 0 ? 1 : 0; };
  const CGAL::Bbox_3 wide = widened(bounds, 0.05 * diagonal);
  const LabelledDomain domain(label, wide, CGAL::parameters::relative_error_bound = kSurfaceTolerance);
  const LabelGrid grid(domain, wide, size / 2);
  if (grid.is_empty())
    throw InvalidInput("--implicit: '" + shape.expression +
                       "' is negative at no point of a grid over the bounds; check --bounds and the sign (f < 0 is "
                       "inside), or give a smaller --size if the shape is thin");
  TetMesh mesh = mesh_labelled(domain, grid, size, options);
  mesh.region.clear();
  return mesh;
}

}  // namespace aspic
