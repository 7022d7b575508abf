// Wavefront OBJ: polygons as text. Reads positions, faces, lines and texture coordinates; ignores normals, groups
// and materials.
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "io/mesh_content.h"
#include "mesh/triangle_shape.h"
#include "mesh/triangle_uv.h"

namespace aspic {

MeshContent parse_obj(const std::string& file, std::string_view contents);
// Returns the texture coordinates (u, v, 0) of the triangles of parse_obj(), in their order. Throws InvalidInput for
// faces that lack them or have no area in them.
std::vector<TriangleCorners> parse_obj_uv(const std::string& file, std::string_view contents);
// Returns the same, or nothing if no corner has texture coordinates. They may have no area. Throws InvalidInput if only
// some corners have them.
std::vector<TriangleCorners> parse_obj_texture(const std::string& file, std::string_view contents);
std::string obj_text(const TriMesh& mesh);
std::string obj_text(const TriMesh& mesh, std::span<const TriangleUv> uv);  // one per triangle
std::string obj_text_of_lines(const TetMesh& mesh);                         // the rods of a mesh

}  // namespace aspic
