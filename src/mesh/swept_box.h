// Boxes around points that move along lines. Two of them are apart if the points move together at a distance.
#pragma once
#include "mesh/box.h"

namespace aspic {

// Contains the points x + t u, 0 <= t <= 1, with x in `start` and u in `move`.
struct SweptBox {
  Box start, move;
  bool is_new = true;  // boxes that are not new overlap new ones only

  void merge(const SweptBox& other) {
    start.merge(other.start);
    move.merge(other.move);
    is_new |= other.is_new;
  }
  bool operator==(const SweptBox&) const = default;
  Vec3d center() const { return start.center(); }
  double sides() const { return start.sides() + move.sides(); }
  // Returns false if no point of this meets a point of the other at the same t.
  bool overlaps(const SweptBox& other) const {
    if (!is_new && !other.is_new) return false;
    double apart = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double closing = std::max(0.0, other.move.upper[axis] - move.lower[axis]);
      const double opening = std::max(0.0, move.upper[axis] - other.move.lower[axis]);
      apart = std::max(apart, std::max(start.lower[axis] - other.start.upper[axis] - closing,
                                       other.start.lower[axis] - start.upper[axis] - opening));
    }
    return !(apart > 0);
  }
};

}  // namespace aspic
