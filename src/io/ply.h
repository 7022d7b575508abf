// PLY: polygons as text or binary of either byte order. Reads positions and faces; ignores other properties.
#pragma once
#include <string>
#include <string_view>

#include "io/mesh_content.h"
#include "io/mesh_file.h"

namespace aspic {

MeshContent parse_ply(const std::string& file, std::string_view contents);
std::string ply_bytes(const TriMesh& mesh, FileEncoding encoding);

}  // namespace aspic
