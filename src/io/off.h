// Object File Format (Geomview): polygons as text. Ignores colors, normals and texture coordinates.
#pragma once
#include <string>
#include <string_view>

#include "io/mesh_content.h"

namespace aspic {

MeshContent parse_off(const std::string& file, std::string_view contents);
std::string off_text(const TriMesh& mesh);

}  // namespace aspic
