// A cage around a closed surface: tets that do not follow the surface, but contain it. The surface is embedded into
// them.
#pragma once
#include "mesh/tet_mesh.h"

namespace aspic {

// Returns the cubes with edges of about `size` [m] that are inside the surface or meet it, each cut into six tets. Has
// no tets if the surface has no extent along an axis. Self-intersecting surfaces are accepted. Throws InvalidInput if
// the bounding box has too many cubes.
TetMesh make_cage(const TriMesh& surface, double size);

}  // namespace aspic
