// Reads and writes mesh files; the extension selects the format. Readers repair nothing.
#pragma once
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "mesh/mesh_groups.h"
#include "mesh/tet_mesh.h"
#include "mesh/triangle_uv.h"

namespace aspic {

struct GltfMotion;
struct GltfSampling;

// A supported file format.
struct MeshFormat {
  std::string extension;  // ".msh"
  std::string name;       // "Gmsh 2.2 and 4.1, ASCII and binary"
  bool reads_tets = false, writes_tets = false, reads_triangles = false, writes_triangles = false;
};
const std::vector<MeshFormat>& mesh_formats();  // all, in the order of help texts

// Returns the tets of the file, or its triangles if it has no tets; quads are split. Quadratic tets become linear, with
// a note in `notes`. Either file names a .node/.ele pair. Throws InvalidInput with file, line (or byte offset) and
// remedy. `groups`: the named parts of tets.
std::variant<TetMesh, TriMesh> read_mesh(const std::string& path, std::vector<std::string>* notes = nullptr,
                                         MeshGroups* groups = nullptr);
// Reads tets. Throws InvalidInput like read_mesh(), and if the file has no tets.
TetMesh read_tet_mesh(const std::string& path, std::vector<std::string>* notes = nullptr, MeshGroups* groups = nullptr);
// Reads triangles, or the boundary of the tets. Throws InvalidInput like read_mesh().
TriMesh read_tri_mesh(const std::string& path);
// Reads the animation of the vertices of read_tri_mesh() (io/gltf_reader.h). Throws InvalidInput.
GltfMotion read_gltf_motion(const std::string& path, const GltfSampling& sampling);

// Reads the texture coordinates (u, v, 0) of the corners of each triangle of an OBJ file. Throws InvalidInput like
// read_mesh(), and if a triangle has none, or no area in them.
std::vector<std::array<Vec3d, 3>> read_uv(const std::string& path);

// Reads the texture coordinates of the triangles of read_tri_mesh(), whose number is `triangles`: `vt` of OBJ,
// TEXCOORD_0 of glTF. Returns nothing if the file has none, or, with the reason in `notes`, if a corner has none or
// invalid ones.
std::vector<TriangleUv> read_texture(const std::string& path, int triangles, std::vector<std::string>& notes);

// Reads the lines of an OBJ, VTU or VTK file as the vertices and rods of a mesh without radius, in the order of the
// file. Throws InvalidInput like read_mesh(), and if the file has no lines.
TetMesh read_line_mesh(const std::string& path);

// Whether the file has lines but neither tets nor triangles. Throws InvalidInput like read_mesh().
bool has_lines_only(const std::string& path);
// Writes the vertices and rods of a mesh as an OBJ or PLY file. Throws InvalidInput like write_mesh().
void write_line_mesh(const std::string& path, const TetMesh& mesh);

enum class FileEncoding { ascii, binary };  // formats of text only reject binary
// Reading the file back gives the same bits. The file appears whole or not at all. Throws InvalidInput if it cannot be
// written, if a coordinate is not finite, or if the format does not hold such elements or this encoding.
void write_mesh(const std::string& path, const TetMesh& mesh, FileEncoding encoding = FileEncoding::ascii);
void write_mesh(const std::string& path, const TriMesh& mesh, FileEncoding encoding = FileEncoding::ascii);
// Writes OBJ with texture coordinates of each triangle. Throws InvalidInput like write_mesh().
void write_textured_mesh(const std::string& path, const TriMesh& mesh, std::span<const TriangleUv> uv);

}  // namespace aspic
