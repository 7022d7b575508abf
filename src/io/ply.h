// PLY: polygons as text or binary of either byte order. Reads positions, faces, and on request one
// numerical property of the vertices; ignores other properties.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "io/mesh_content.h"
#include "io/mesh_file.h"

namespace aspic {

MeshContent parse_ply(const std::string& file, std::string_view contents);

struct PaintedSurface {
  TriMesh surface;
  std::vector<double> value;  // one per vertex
};
// Throws InvalidInput with the known names if vertices have no such property.
PaintedSurface parse_painted_ply(const std::string& file, std::string_view contents, const std::string& attribute);

std::string ply_bytes(const TriMesh& mesh, FileEncoding encoding);
std::string ply_bytes_of_lines(const TetMesh& mesh);  // the rods of a mesh as edges

}  // namespace aspic
