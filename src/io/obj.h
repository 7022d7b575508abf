// Wavefront OBJ: polygons as text. Only positions and faces are kept; texture, normals, groups and materials are not.
#pragma once
#include <string>
#include <string_view>

#include "io/mesh_content.h"

namespace aspic {

MeshContent parse_obj(const std::string& file, std::string_view contents);
std::string obj_text(const TriMesh& mesh);

}  // namespace aspic
