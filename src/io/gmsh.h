// Gmsh .msh: reads versions 2.2 and 4.1, text and binary; writes 2.2, which every program reads. The region of a tet is
// its first physical group, or its elementary entity if it has no group.
#pragma once
#include <string>
#include <string_view>

#include "io/mesh_content.h"
#include "io/mesh_file.h"

namespace aspic {

MeshContent parse_gmsh(const std::string& file, std::string_view contents);
std::string gmsh_bytes(const TetMesh& mesh, FileEncoding encoding);
std::string gmsh_bytes(const TriMesh& mesh, FileEncoding encoding);

}  // namespace aspic
