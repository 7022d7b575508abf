// PLY: polygons with any further properties, as text or in binary of either byte order. Only positions and faces are
// kept.
#pragma once
#include <string>
#include <string_view>

#include "io/mesh_content.h"
#include "io/mesh_file.h"

namespace aspic {

MeshContent parse_ply(const std::string& file, std::string_view contents);
std::string ply_bytes(const TriMesh& mesh, FileEncoding encoding);

}  // namespace aspic
