#include "unit_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/formatted.h"
#include "mesh/box_tree.h"

namespace aspic {
namespace {

constexpr double kLargest = 1e75;     // keeps fourth powers of lengths finite, as in dihedral angles
constexpr double kSmallest = 1e-75;   // keeps them positive
constexpr double kResolution = 1e-6;  // largest spacing of coordinates, relative to the extent

}  // namespace

Vec3d extent(const std::vector<Vec3d>& points) {
  Box box;
  for (const Vec3d& x : points) box.add(x);
  return box.upper - box.lower;
}

double diagonal(const std::vector<Vec3d>& points) {
  const Vec3d span = extent(points);
  return norm(span);
}

UnitFrame unit_frame(const std::string& name, const std::vector<Vec3d>& points) {
  Box box;
  for (const Vec3d& x : points) box.add(x);
  double extent = 0, largest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    extent = std::max(extent, box.upper[axis] / 2 - box.lower[axis] / 2);
    largest = std::max({largest, std::abs(box.lower[axis]), std::abs(box.upper[axis])});
  }
  extent *= 2;
  if (!(extent > 0)) throw InvalidInput(name + ": all vertices coincide; use a closed surface");
  if (!(extent < kLargest) || !(extent > kSmallest))
    throw InvalidInput(name + ": the shape is " + three_digits(extent) +
                       " long, which is not between 1e-75 and 1e75; scale it");
  const double spacing = std::nextafter(largest, std::numeric_limits<double>::infinity()) - largest;
  if (spacing > kResolution * extent)
    throw InvalidInput(name + ": coordinates of " + three_digits(largest) + " are multiples of " +
                       three_digits(spacing) + " in double precision, too coarse for a shape " + three_digits(extent) +
                       " long; move it closer to the origin in the source model");
  UnitFrame frame{{}, std::ldexp(1.0, std::ilogb(extent))};
  if (largest > 4 * extent)  // a multiple of the unit, so that differences stay exact
    for (int axis = 0; axis < 3; ++axis)
      frame.origin[axis] = frame.unit * std::round((box.lower[axis] / 2 + box.upper[axis] / 2) / frame.unit);
  return frame;
}

void to_frame(const UnitFrame& frame, std::vector<Vec3d>& points) {
  for (Vec3d& x : points)
    for (int axis = 0; axis < 3; ++axis) x[axis] = (x[axis] - frame.origin[axis]) / frame.unit;
}

void from_frame(const UnitFrame& frame, std::vector<Vec3d>& points) {
  for (Vec3d& x : points)
    for (int axis = 0; axis < 3; ++axis) x[axis] = frame.origin[axis] + frame.unit * x[axis];
}

void check_size(const Vec3d& extent, double size) {
  constexpr double kMaxCells = 1e9;  // limit of cubes of that size in the bounding box
  double cells = 1;
  for (int axis = 0; axis < 3; ++axis) cells *= extent[axis] / size + 1;
  if (cells > kMaxCells)
    throw InvalidInput("--size " + three_digits(size) + ": too fine for a shape " +
                       three_digits(std::max({extent[0], extent[1], extent[2]})) +
                       " long; --size is in units of the input, give a larger one");
}

}  // namespace aspic
