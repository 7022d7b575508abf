// Orientation of triangle surfaces.
#pragma once
#include <cstddef>

#include "mesh/tet_mesh.h"

namespace aspic {

double enclosed_volume(const TriMesh& mesh);  // by the divergence theorem [m^3]; negative if oriented inward

// Orients each sheet of the surface consistently by flipping as few triangles as possible. A single closed sheet is
// then oriented outward; of several sheets one may bound a cavity, so their sides are kept. Sheets that are not
// orientable (Moebius strip) remain unchanged. Returns the number of flipped triangles.
size_t orient(TriMesh& mesh);

}  // namespace aspic
