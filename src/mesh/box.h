// Axis-aligned boxes.
#pragma once
#include <algorithm>
#include <limits>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

// Axis-aligned box; empty until points are added.
struct Box {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Vec3d lower = {{kInfinity, kInfinity, kInfinity}}, upper = {{-kInfinity, -kInfinity, -kInfinity}};

  void add(const Vec3d& x) {
    for (int axis = 0; axis < 3; ++axis) {
      lower[axis] = std::min(lower[axis], x[axis]);
      upper[axis] = std::max(upper[axis], x[axis]);
    }
  }
  void merge(const Box& other) {
    add(other.lower);
    add(other.upper);
  }
  Vec3d center() const { return 0.5 * lower + 0.5 * upper; }
  double sides() const {  // sum of the lengths of its sides [m]; 0: empty
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) sum += std::max(upper[axis] - lower[axis], 0.0);
    return sum;
  }
  bool overlaps(const Box& other) const {
    double apart = 0;  // largest gap along an axis; branch-free, because searches would mispredict branches
    for (int axis = 0; axis < 3; ++axis)
      apart = std::max(apart, std::max(lower[axis] - other.upper[axis], other.lower[axis] - upper[axis]));
    return !(apart > 0);
  }
  bool operator==(const Box& other) const {
    return std::equal(lower.a, lower.a + 3, other.lower.a) && std::equal(upper.a, upper.a + 3, other.upper.a);
  }
  bool contains(const Vec3d& x) const { return overlaps({x, x}); }
  double squared_distance(const Vec3d& x) const {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double away = std::max({lower[axis] - x[axis], x[axis] - upper[axis], 0.0});
      sum += away * away;
    }
    return sum;
  }
  // Returns the parameter s >= 0 at which origin + s direction enters the box; infinity if it misses.
  double entry(const Vec3d& origin, const Vec3d& direction) const {
    double first = 0, last = kInfinity;
    for (int axis = 0; axis < 3; ++axis) {
      if (direction[axis] == 0) {
        if (origin[axis] < lower[axis] || origin[axis] > upper[axis]) return kInfinity;
        continue;
      }
      double in = (lower[axis] - origin[axis]) / direction[axis], out = (upper[axis] - origin[axis]) / direction[axis];
      if (out < in) std::swap(in, out);
      first = std::max(first, in);
      last = std::min(last, out);
    }
    return first <= last ? first : kInfinity;
  }
};

Box bounding_box(const std::vector<Vec3d>& X);
double longest_side(const Box& box);  // [m]
double size_of(const TetMesh& mesh);  // diagonal of the bounding box at rest [m]

}  // namespace aspic
