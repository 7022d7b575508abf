// Reads the triangles of glTF 2.0, as .glb or .gltf [Khronos], and their animation: the meshes of the default scene,
// placed by their nodes or, with a skin, by its joints.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "io/mesh_content.h"
#include "mesh/triangle_shape.h"

namespace aspic {

// Returns the bytes of a file beside the .gltf. Throws InvalidInput.
using ReadBeside = std::function<std::string(const std::string& name)>;

// Returns the contents of a file of any format; a glTF file that names buffers beside it then contains them. Pictures,
// which nothing reads, stay outside. Throws InvalidInput.
std::string read_self_contained(const std::filesystem::path& path);

// Vertices of a node at the same position become one, since glTF repeats them along edges of normals and textures.
// Morph targets and animations are ignored. Throws InvalidInput.
MeshContent parse_gltf(const std::string& file, std::string_view contents, const ReadBeside& read_beside);

// Returns the texture coordinates (u, v, 0) of the triangles of parse_gltf(), with v upward; nothing if no mesh has
// TEXCOORD_0. Throws InvalidInput if only some have it.
std::vector<TriangleCorners> parse_gltf_texture(const std::string& file, std::string_view contents,
                                                const ReadBeside& read_beside);

struct GltfSampling {
  double rate;                 // samples per second
  std::string animation = {};  // name; empty: the only one
};

struct GltfMotion {
  std::vector<double> times;                 // ascending from 0 to the last keyframe [s]
  std::vector<std::vector<Vec3d>> vertices;  // of each time, numbered like those of parse_gltf [m]
};

// Samples an animation of nodes and joints. Throws InvalidInput, also above 1 GiB.
GltfMotion parse_gltf_motion(const std::string& file, std::string_view contents, const ReadBeside& read_beside,
                             const GltfSampling& sampling);

}  // namespace aspic
