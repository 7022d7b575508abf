// Connected components of a mesh: elements that are connected through shared vertices.
#pragma once
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

// Return the ascending element indices of each component; components are in the order of their first element.
std::vector<std::vector<int>> tet_components(const TetMesh& mesh);
std::vector<std::vector<int>> element_components(const TetMesh& mesh);  // of tets and sheets, by their corners
std::vector<std::vector<int>> triangle_components(const TriMesh& mesh);

}  // namespace aspic
