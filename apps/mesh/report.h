// Messages about a mesh.
#pragma once
#include <string>

#include "mesh/tet_mesh.h"

namespace aspic {

std::string quality_report(const TetMesh& mesh, double seconds);

}  // namespace aspic
