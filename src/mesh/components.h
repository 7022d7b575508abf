// Parts of a mesh that hang together through shared vertices.
#pragma once
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

// Indices of the elements of each component, ascending; components in the order of their first element.
std::vector<std::vector<int>> tet_components(const TetMesh& mesh);
std::vector<std::vector<int>> triangle_components(const TriMesh& mesh);

}  // namespace aspic
