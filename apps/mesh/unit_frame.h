// A frame in which a shape has unit size and lies around the origin, so that meshing neither overflows nor depends on
// the units of the file.
#pragma once
#include <string>
#include <vector>

#include "math/small.h"

namespace aspic {

Vec3d extent(const std::vector<Vec3d>& points);     // of the bounding box
double diagonal(const std::vector<Vec3d>& points);  // of the bounding box

// Position in the file = origin + unit * position in the frame. The unit is a power of two.
struct UnitFrame {
  Vec3d origin{};
  double unit = 1;
};

// The frame of the box of these points. Its origin is 0 unless they are far from it. `name` is the file or the option
// in messages. Throws InvalidInput for a box that double precision cannot resolve.
UnitFrame unit_frame(const std::string& name, const std::vector<Vec3d>& points);

void to_frame(const UnitFrame& frame, std::vector<Vec3d>& points);
void from_frame(const UnitFrame& frame, std::vector<Vec3d>& points);

// Throws InvalidInput for edges of length `size` in a box of this extent that would never end, as when they are given
// in other units than the input.
void check_size(const Vec3d& extent, double size);

}  // namespace aspic
