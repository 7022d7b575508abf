// Mesh files by their extension. Readers give what the file says, unrepaired: the doctor judges it.
#pragma once
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

struct MeshFormat {
  std::string extension;  // ".msh"
  std::string name;       // "Gmsh 2.2 and 4.1, ASCII and binary"
  bool reads_tets = false, writes_tets = false, reads_triangles = false, writes_triangles = false;
};
const std::vector<MeshFormat>& mesh_formats();

// Tets when the file has any, otherwise its triangles (quads are split). A .node/.ele pair is named by either file.
// Throws InvalidInput with file, line (or byte offset) and remedy.
std::variant<TetMesh, TriMesh> read_mesh(const std::filesystem::path& path);
TetMesh read_tet_mesh(const std::filesystem::path& path);  // an error for a file without tets
TriMesh read_tri_mesh(const std::filesystem::path& path);  // of a tet mesh: its boundary

enum class FileEncoding { ascii, binary };
// Numbers are written so that they read back to the same bits. The file appears whole or not at all.
void write_mesh(const std::filesystem::path& path, const TetMesh& mesh, FileEncoding encoding = FileEncoding::ascii);
void write_mesh(const std::filesystem::path& path, const TriMesh& mesh, FileEncoding encoding = FileEncoding::ascii);

}  // namespace aspic
