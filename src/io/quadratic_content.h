// Quadratic tets of mesh files.
#pragma once
#include <string>

#include "io/mesh_content.h"

namespace aspic {

// Removes the mid-edge nodes, so that edges are straight and tets linear. Returns a note that states by how much edges
// were curved; empty if the content has no quadratic tets.
std::string remove_mid_nodes(MeshContent& content);

}  // namespace aspic
