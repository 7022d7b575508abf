// STL: loose triangles, as text or in binary. Corners at the same place become one vertex.
#pragma once
#include <string>
#include <string_view>

#include "io/mesh_content.h"
#include "io/mesh_file.h"

namespace aspic {

MeshContent parse_stl(const std::string& file, std::string_view contents);

// Binary STL holds single precision, so there coordinates are rounded. InvalidInput when one is too large for that.
std::string stl_bytes(const std::string& file, const TriMesh& mesh, FileEncoding encoding);

}  // namespace aspic
