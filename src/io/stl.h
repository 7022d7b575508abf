// STL: unconnected triangles, as text or binary. Merges corners at the same position.
#pragma once
#include <string>
#include <string_view>

#include "io/mesh_content.h"
#include "io/mesh_file.h"

namespace aspic {

MeshContent parse_stl(const std::string& file, std::string_view contents);

// Binary STL rounds coordinates to single precision. Throws InvalidInput if one is too large for that.
std::string stl_bytes(const std::string& file, const TriMesh& mesh, FileEncoding encoding);

}  // namespace aspic
