// A disc of concentric rings, and the solids swept by it. Shared by the cylinder and the torus.
#pragma once
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

// Ring k of `rings` has 6 k points at radius k / rings; triangles are counter-clockwise in the (x, y) plane.
// Smallest angle 30 degrees or more for any number of rings.
struct Disc {
  std::vector<std::array<double, 2>> points;  // of the unit disc
  std::vector<Triangle> triangles;
};
Disc make_disc(int rings);

// The prisms between copies of the disc, three tets each: vertex v of copy k has index k * points + v. With `closed`
// the last copy is joined to the first. Each side of a prism is cut from the smaller disc vertex below to the larger
// above, so neighbors match.
std::vector<Tet> swept_tets(const Disc& disc, int copies, bool closed);

}  // namespace aspic
