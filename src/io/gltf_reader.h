// Reads the triangles of glTF 2.0, as .glb or .gltf [Khronos]: the meshes of the default scene, placed by their nodes.
#pragma once
#include <functional>
#include <string>
#include <string_view>

#include "io/mesh_content.h"

namespace aspic {

// Returns the bytes of a file beside the .gltf. Throws InvalidInput.
using ReadBeside = std::function<std::string(const std::string& name)>;

// Vertices of a node at the same position become one, since glTF repeats them along edges of normals and textures.
// Skinned meshes are in their bind pose, morph targets and animations are ignored. Throws InvalidInput.
MeshContent parse_gltf(const std::string& file, std::string_view contents, const ReadBeside& read_beside);

}  // namespace aspic
