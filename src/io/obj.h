// Wavefront OBJ: polygons as text. Reads positions, faces and lines; ignores texture, normals, groups and materials.
#pragma once
#include <string>
#include <string_view>

#include "io/mesh_content.h"

namespace aspic {

MeshContent parse_obj(const std::string& file, std::string_view contents);
std::string obj_text(const TriMesh& mesh);
std::string obj_text_of_lines(const TetMesh& mesh);  // the rods of a mesh

}  // namespace aspic
