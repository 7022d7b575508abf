#include "io/mesh_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <system_error>

#include "base/check.h"
#include "base/error.h"
#include "base/free_memory.h"
#include "io/atomic_file.h"
#include "io/foreign_formats.h"
#include "io/gltf.h"
#include "io/gltf_reader.h"
#include "io/gmsh.h"
#include "io/legacy_vtk.h"
#include "io/medit.h"
#include "io/mesh_content.h"
#include "io/obj.h"
#include "io/off.h"
#include "io/ply.h"
#include "io/quadratic_content.h"
#include "io/stl.h"
#include "io/tetgen.h"
#include "io/vtu.h"
#include "mesh/surface.h"
#include "mesh/tet_nodes.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;

// Row of the table of formats; a null function marks an unsupported operation.
struct Format {
  std::string extension, name;
  MeshContent (*read)(const fs::path&);
  void (*write_tets)(const fs::path&, const TetMesh&, FileEncoding);
  void (*write_triangles)(const fs::path&, const TriMesh&, FileEncoding);
  bool holds_tets, holds_triangles;
};

template <MeshContent (*parse)(const std::string&, std::string_view)>
MeshContent read_text(const fs::path& path) {
  return parse(path.string(), read_file(path));
}

void check_ascii(const fs::path& path, FileEncoding encoding) {
  if (encoding == FileEncoding::binary)
    throw InvalidInput(path.string() + ": this format is text only; write ASCII, or choose .msh, .ply or .stl");
}

template <class Mesh, std::string (*text)(const Mesh&)>
void write_text(const fs::path& path, const Mesh& mesh, FileEncoding encoding) {
  check_ascii(path, encoding);
  write_file(path, text(mesh));
}

template <class Mesh, std::string (*bytes)(const Mesh&, FileEncoding)>
void write_bytes(const fs::path& path, const Mesh& mesh, FileEncoding encoding) {
  write_file(path, bytes(mesh, encoding));
}

void write_stl(const fs::path& path, const TriMesh& mesh, FileEncoding encoding) {
  write_file(path, stl_bytes(path.string(), mesh, encoding));
}

// The other file of a .node/.ele pair, in the same letter case.
fs::path partner(const fs::path& path, const std::string& lower_extension) {
  std::string extension = lower_extension;
  if (const std::string given = path.extension().string(); given.size() > 1 && std::isupper(given[1]))
    for (char& c : extension) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return fs::path(path).replace_extension(extension);
}

MeshContent read_tetgen(const fs::path& path) {
  const fs::path node = partner(path, ".node"), ele = partner(path, ".ele");
  std::error_code error;
  for (const fs::path& file : {node, ele})
    if (!fs::exists(file, error))
      throw InvalidInput(file.string() + ": does not exist; a TetGen mesh is a pair of .node and .ele");
  return parse_tetgen(node.string(), read_file(node), ele.string(), read_file(ele));
}

void write_tetgen(const fs::path& path, const TetMesh& mesh, FileEncoding encoding) {
  check_ascii(path, encoding);
  const TetgenText text = tetgen_text(mesh);
  write_file(partner(path, ".node"), text.node);
  write_file(partner(path, ".ele"), text.ele);
}

// Text and mesh are in memory together; a mesh needs about as much as its text.
void check_memory(const fs::path& path) {
  constexpr std::uintmax_t kSmall = std::uintmax_t{1} << 24;
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(path, error);
  if (error || bytes < kSmall) return;
  const auto available = static_cast<std::uintmax_t>(free_memory());
  if (bytes > available / 2)
    throw InvalidInput(path.string() + ": is " + std::to_string(bytes) + " bytes, and reading it takes twice that; " +
                       std::to_string(available) + " bytes of memory are free; use a coarser mesh");
}

ReadBeside files_beside(const fs::path& path) {
  return [folder = path.parent_path()](const std::string& name) {
    check_memory(folder / name);
    return read_file(folder / name);
  };
}

MeshContent read_gltf(const fs::path& path) { return parse_gltf(path.string(), read_file(path), files_beside(path)); }

void write_glb(const fs::path& path, const TriMesh& mesh, FileEncoding) {
  GltfMesh gltf{.name = path.stem().string(), .triangles = mesh.triangles, .frames = {{}}};
  for (const Vec3d& x : mesh.vertices)
    for (const double coordinate : x.a) {
      gltf.frames[0].push_back(static_cast<float>(coordinate));
      if (!std::isfinite(gltf.frames[0].back()))
        throw InvalidInput(path.string() + ": not written, since a vertex is too far out for single precision");
    }
  write_file(path, glb({.meshes = {std::move(gltf)}, .times = {}}));
}

MeshContent read_vtk_mesh(const fs::path& path) {
  Vtu vtu = read_vtk_or_vtu(path);
  if (!vtu.mesh.tets.empty())
    return {
        std::move(vtu.mesh.rest), std::move(vtu.mesh.tets), std::move(vtu.mesh.region), {}, std::move(vtu.mesh.mids)};
  return {
      std::move(vtu.triangles.vertices), {}, {}, std::move(vtu.triangles.triangles), {}, {}, std::move(vtu.segments)};
}

void write_vtu_mesh(const fs::path& path, const TetMesh& mesh, FileEncoding) {
  const std::span<const double> points(mesh.rest.empty() ? nullptr : mesh.rest[0].a, 3 * mesh.rest.size());
  std::vector<Field> cell_fields;
  if (!mesh.region.empty()) cell_fields.push_back({"region", 1, {mesh.region.begin(), mesh.region.end()}});
  write_vtu(path, points, mesh, {.cell_fields = cell_fields});
}

const std::vector<Format>& formats() {
  static const std::vector<Format> table = {
      {".msh", "Gmsh 2.2 and 4.1, ASCII and binary", read_text<parse_gmsh>, write_bytes<TetMesh, gmsh_bytes>,
       write_bytes<TriMesh, gmsh_bytes>, true, true},
      {".mesh", "Medit, ASCII", read_text<parse_medit>, write_text<TetMesh, medit_text>,
       write_text<TriMesh, medit_text>, true, true},
      {".node", "TetGen .node and .ele", read_tetgen, write_tetgen, nullptr, true, false},
      {".ele", "TetGen .node and .ele", read_tetgen, write_tetgen, nullptr, true, false},
      {".vtu", "VTK XML unstructured grid", read_vtk_mesh, write_vtu_mesh, nullptr, true, true},
      {".vtk", "VTK legacy, text and binary", read_vtk_mesh, nullptr, nullptr, true, true},
      {".obj", "Wavefront OBJ", read_text<parse_obj>, nullptr, write_text<TriMesh, obj_text>, false, true},
      {".ply", "PLY, ASCII and binary", read_text<parse_ply>, nullptr, write_bytes<TriMesh, ply_bytes>, false, true},
      {".stl", "STL, ASCII and binary", read_text<parse_stl>, nullptr, write_stl, false, true},
      {".glb", "glTF 2.0", read_gltf, nullptr, write_glb, false, true},
      {".gltf", "glTF 2.0", read_gltf, nullptr, nullptr, false, true},
      {".off", "OFF, ASCII", read_text<parse_off>, nullptr, write_text<TriMesh, off_text>, false, true},
  };
  return table;
}

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

const Format& format_of(const fs::path& path) {
  const std::string extension = lower(path.extension().string());
  std::vector<std::string> known;
  for (const Format& format : formats()) {
    if (format.extension == extension) return format;
    known.push_back(format.extension);
  }
  if (const std::string remedy = remedy_for_foreign_format(extension); !remedy.empty())
    throw InvalidInput(path.string() + ": " + remedy);
  throw InvalidInput(path.string() + ": no mesh format has the extension '" + extension + "'" +
                     suggestion(extension, known));
}

void check_vertices(const fs::path& path, const std::vector<Vec3d>& vertices) {
  for (size_t i = 0; i < vertices.size(); ++i)
    for (const double coordinate : vertices[i].a)
      if (!std::isfinite(coordinate))
        throw InvalidInput(path.string() + ": not written, since vertex " + std::to_string(i) +
                           " has a coordinate that is not finite; find out where it comes from");
}

std::vector<TriangleCorners> parse_texture(const fs::path& path) {
  const std::string extension = lower(path.extension().string());
  if (extension == ".obj") return parse_obj_texture(path.string(), read_file(path));
  if (extension != ".glb" && extension != ".gltf") return {};
  return parse_gltf_texture(path.string(), read_file(path), files_beside(path));
}

// Throws InvalidInput beyond single precision.
TriangleUv rounded(const TriangleCorners& corners, const std::string& path) {
  TriangleUv uv;
  for (size_t c = 0; c < 3; ++c)
    for (int r = 0; r < 2; ++r) {
      if (std::abs(corners[c][r]) > std::numeric_limits<float>::max())
        throw InvalidInput(path + ": a texture coordinate exceeds single precision; unwrap the mesh again");
      uv[c][static_cast<size_t>(r)] = static_cast<float>(corners[c][r]);
    }
  return uv;
}

template <class Elements>
bool are_indices_valid(const Elements& elements, int vertices) {
  for (const auto& element : elements)
    for (const int vertex : element)
      if (vertex < 0 || vertex >= vertices) return false;
  return true;
}

}  // namespace

const std::vector<MeshFormat>& mesh_formats() {
  static const std::vector<MeshFormat> list = [] {
    std::vector<MeshFormat> result;
    for (const Format& format : formats())
      result.push_back({format.extension, format.name, format.holds_tets, format.write_tets != nullptr,
                        format.holds_triangles, format.write_triangles != nullptr});
    return result;
  }();
  return list;
}

std::variant<TetMesh, TriMesh> read_mesh(const std::string& path, std::vector<std::string>* notes, MeshGroups* groups) {
  const Format& format = format_of(path);
  check_memory(path);
  MeshContent content = format.read(path);
  const std::string note = remove_mid_nodes(content);
  if (notes && !note.empty()) notes->push_back(fs::path(path).filename().string() + ": " + note);
  if (groups) *groups = std::move(content.groups);
  if (!content.tets.empty())
    return TetMesh{std::move(content.vertices), std::move(content.tets), std::move(content.region)};
  if (!content.triangles.empty()) return TriMesh{std::move(content.vertices), std::move(content.triangles)};
  if (!content.segments.empty())
    throw InvalidInput(path + ": holds lines alone, which are a rod; run it, or give a body `rod`");
  throw InvalidInput(path + ": holds " +
                     (format.holds_tets && format.holds_triangles ? "neither tets nor triangles"
                      : format.holds_tets                         ? "no tets"
                                                                  : "no faces") +
                     "; export the mesh again with its elements");
}

TetMesh read_tet_mesh(const std::string& path, std::vector<std::string>* notes, MeshGroups* groups) {
  auto mesh = read_mesh(path, notes, groups);
  if (auto* tets = std::get_if<TetMesh>(&mesh)) return std::move(*tets);
  throw InvalidInput(path + ": holds a surface, no tets; fill it with 'aspic mesh " +
                     fs::path(path).filename().string() + " -o " + fs::path(path).stem().string() + ".msh'");
}

TetMesh read_line_mesh(const std::string& path) {
  const Format& format = format_of(path);
  check_memory(path);
  MeshContent content = format.read(path);
  if (content.segments.empty())
    throw InvalidInput(path +
                       ": holds no lines; a rod needs 'l' statements of an OBJ file, or line cells of a VTU or "
                       "VTK file without tets");
  TetMesh mesh{.rest = std::move(content.vertices), .tets = {}, .region = {}};
  mesh.rods = std::move(content.segments);
  return mesh;
}

std::vector<std::array<Vec3d, 3>> read_uv(const std::string& path) {
  if (format_of(path).extension != ".obj")
    throw InvalidInput(path + ": has no texture coordinates that Aspic reads; export it as Wavefront OBJ with UVs");
  check_memory(path);
  return parse_obj_uv(path, read_file(path));
}

std::vector<TriangleUv> read_texture(const std::string& path, int triangles, std::vector<std::string>& notes) {
  try {
    std::vector<TriangleUv> uv;
    for (const TriangleCorners& corners : parse_texture(path)) uv.push_back(rounded(corners, path));
    if (!uv.empty() && std::ssize(uv) != triangles) throw InvalidInput(path + ": changed while it was read; run again");
    return uv;
  } catch (const InvalidInput& e) {
    notes.push_back(e.what() + std::string("; the results have no texture coordinates"));
    return {};
  }
}

bool has_lines_only(const std::string& path) {
  const MeshContent content = format_of(path).read(path);
  return content.tets.empty() && content.triangles.empty() && !content.segments.empty();
}

void write_line_mesh(const std::string& path, const TetMesh& mesh) {
  ASPIC_CHECK(are_indices_valid(mesh.rods, mesh.vertex_count()));
  check_vertices(path, mesh.rest);
  write_file(path, fs::path(path).extension() == ".ply" ? ply_bytes_of_lines(mesh) : obj_text_of_lines(mesh));
}

TriMesh read_tri_mesh(const std::string& path) {
  auto mesh = read_mesh(path);
  if (auto* triangles = std::get_if<TriMesh>(&mesh)) return std::move(*triangles);
  return boundary_surface(std::get<TetMesh>(mesh)).surface;
}

GltfMotion read_gltf_motion(const std::string& path, const GltfSampling& sampling) {
  check_memory(path);
  return parse_gltf_motion(path, read_file(path), files_beside(path), sampling);
}

void write_mesh(const std::string& path, const TetMesh& mesh, FileEncoding encoding) {
  const Format& format = format_of(path);
  if (!format.write_tets)
    throw InvalidInput(path + ": " + format.name + " is not written for tets; write .msh, .mesh, .node or .vtu");
  ASPIC_CHECK(mesh.region.empty() || mesh.region.size() == mesh.tets.size());
  ASPIC_CHECK(are_indices_valid(mesh.tets, mesh.vertex_count()));
  check_vertices(path, mesh.rest);
  if (mesh.mids.empty())
    format.write_tets(path, mesh, encoding);
  else
    format.write_tets(path, lower_order(mesh), encoding);
}

void write_mesh(const std::string& path, const TriMesh& mesh, FileEncoding encoding) {
  const Format& format = format_of(path);
  if (!format.write_triangles)
    throw InvalidInput(path + ": " + format.name +
                       " is not written for triangles; write .obj, .ply, .stl, .off, .msh or .mesh");
  ASPIC_CHECK(are_indices_valid(mesh.triangles, mesh.vertex_count()));
  check_vertices(path, mesh.vertices);
  format.write_triangles(path, mesh, encoding);
}

void write_textured_mesh(const std::string& path, const TriMesh& mesh, std::span<const TriangleUv> uv) {
  ASPIC_CHECK(are_indices_valid(mesh.triangles, mesh.vertex_count()) && uv.size() == mesh.triangles.size());
  check_vertices(path, mesh.vertices);
  write_file(path, obj_text(mesh, uv));
}

}  // namespace aspic
