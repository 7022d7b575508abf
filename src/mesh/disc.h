// Discs of concentric rings and the solids that they sweep: cylinder and torus.
#pragma once
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

// Ring k of `rings` has 6 k points at radius k / rings. Triangles are counter-clockwise in the (x, y) plane. All angles
// are at least 30 degrees for any number of rings.
struct Disc {
  std::vector<std::array<double, 2>> points;  // points of the unit disc
  std::vector<Triangle> triangles;
};
Disc make_disc(int rings);

// Returns the tets of the prisms between copies of the disc, three per prism. Vertex v of copy k has index k * points +
// v. With `closed` the last copy is joined to the first. The diagonal of each side of a prism connects the smaller disc
// vertex below to the larger one above, so that neighbors match.
std::vector<Tet> swept_tets(const Disc& disc, int copies, bool closed);

}  // namespace aspic
