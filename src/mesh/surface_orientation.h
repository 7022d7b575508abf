// Which way the triangles of a surface face.
#pragma once
#include <cstddef>

#include "mesh/tet_mesh.h"

namespace aspic {

double enclosed_volume(const TriMesh& mesh);  // [m^3] by the divergence theorem; negative when it faces inwards

// Makes each sheet of the surface agree in itself, turning the fewer triangles. When the surface is one closed sheet it
// is then made to face outwards; of several, one may bound a cavity, and to decide that would be to guess. Sheets that
// cannot agree (a Moebius strip) are left alone. Returns how many triangles turned.
size_t orient(TriMesh& mesh);

}  // namespace aspic
