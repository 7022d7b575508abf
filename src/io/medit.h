// Medit .mesh, text: sections in any order, each with a keyword and a count. A tet's reference is its region.
#pragma once
#include <string>
#include <string_view>

#include "io/mesh_content.h"

namespace aspic {

MeshContent parse_medit(const std::string& file, std::string_view contents);
std::string medit_text(const TetMesh& mesh);
std::string medit_text(const TriMesh& mesh);

}  // namespace aspic
