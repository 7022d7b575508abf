// Texture coordinates of the triangles of a surface.
#pragma once
#include <array>

namespace aspic {

// (u, v) of each corner, with v upward. Triangles may have different ones at a common vertex, as at seams.
using TriangleUv = std::array<std::array<float, 2>, 3>;

}  // namespace aspic
