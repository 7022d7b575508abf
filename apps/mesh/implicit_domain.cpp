#include <cmath>

#include "labeled.h"
#include "scene/expression.h"
#include "unit_frame.h"

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

// A shape that extends beyond the bounds is clipped.
TetMesh mesh_implicit(const ImplicitShape& shape, const MesherOptions& options) {
  std::vector<Vec3d> corners = {shape.lower, shape.upper};
  bounding_box(shape.lower, shape.upper);  // throws if empty
  const UnitFrame frame = unit_frame("--bounds", corners);
  to_frame(frame, corners);
  const CGAL::Bbox_3 bounds = bounding_box(corners[0], corners[1]);
  const double diagonal = std::hypot(bounds.x_span(), bounds.y_span(), bounds.z_span());
  MesherOptions in_frame{.size = options.size > 0 ? options.size / frame.unit : diagonal / 25, .region_size = {}};
  check_size(shape.upper - shape.lower, in_frame.size * frame.unit);
  const Expression f = parsed(shape.expression);
  const auto label = [&](const Point& p) {
    if (!contains(bounds, p)) return 0;
    double x[3];
    for (int axis = 0; axis < 3; ++axis) x[axis] = frame.origin[axis] + frame.unit * p[axis];
    return f.at({{x[0], x[1], x[2]}}) < 0 ? 1 : 0;
  };
  const CGAL::Bbox_3 wide = widened(bounds, 0.05 * diagonal);
  const LabeledDomain domain(label, wide, CGAL::parameters::relative_error_bound = kSurfaceTolerance);
  const LabelGrid grid(domain, wide, in_frame.size / 2);
  if (grid.is_empty())
    throw InvalidInput("--implicit: '" + shape.expression +
                       "' is negative at no point of a grid over the bounds; check --bounds and the sign (f < 0 is "
                       "inside), or give a smaller --size if the shape is thin");
  TetMesh mesh = mesh_labeled("--implicit", domain, grid, in_frame);
  from_frame(frame, mesh.rest);
  mesh.region.clear();
  return mesh;
}

}  // namespace aspic
