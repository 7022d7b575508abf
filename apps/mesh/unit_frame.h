// A frame in which a shape has unit size near the origin, so that meshing neither overflows nor depends on the units of
// the file.
#pragma once
#include <string>
#include <vector>

#include "math/small.h"

namespace aspic {

Vec3d extent(const std::vector<Vec3d>& points);     // size of the bounding box
double diagonal(const std::vector<Vec3d>& points);  // diagonal of the bounding box

// Position in the file = origin + unit * position in the frame. The unit is a power of two.
struct UnitFrame {
  Vec3d origin{};
  double unit = 1;
};

// Returns the frame of the bounding box of these points. Its origin is 0 unless they are far from it. `name` is the
// file or the option in messages. Throws InvalidInput if double precision cannot resolve the box.
UnitFrame unit_frame(const std::string& name, const std::vector<Vec3d>& points);

void to_frame(const UnitFrame& frame, std::vector<Vec3d>& points);
void from_frame(const UnitFrame& frame, std::vector<Vec3d>& points);

// Throws InvalidInput if edges of length `size` are far too small for a box of this extent, for instance because they
// are in other units than the input.
void check_size(const Vec3d& extent, double size);

}  // namespace aspic
