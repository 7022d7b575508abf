#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include "io/gltf_reader.h"
#include "io/gmsh.h"
#include "io/gmsh_slices.h"
#include "io/legacy_vtk.h"
#include "io/medit.h"
#include "io/mesh_content.h"
#include "io/obj.h"
#include "io/off.h"
#include "io/ply.h"
#include "io/stl.h"
#include "io/tetgen.h"
#include "io/vtu.h"
#include "mesh/doctor.h"
#include "mesh/surface.h"
#include "several_files.h"
#include "targets.h"

namespace aspic::fuzz {
namespace {

template <class Elements>
void require_indices(const Elements& elements, size_t vertices) {
  for (const auto& element : elements)
    for (const int v : element) require(v >= 0 && static_cast<size_t>(v) < vertices, "indices are in range");
}

void require_finite(const std::vector<Vec3d>& vertices) {
  for (const Vec3d& vertex : vertices)
    for (const double x : vertex.a) require(std::isfinite(x), "coordinates are finite");
}

void require_valid(const MeshContent& mesh) {
  require_finite(mesh.vertices);
  require_indices(mesh.tets, mesh.vertices.size());
  require_indices(mesh.triangles, mesh.vertices.size());
  for (const SurfaceGroup& group : mesh.groups.surfaces) {
    require_indices(group.triangles, mesh.vertices.size());
    fuzz::require_printable({group.name});
  }
  for (const auto& [label, name] : mesh.groups.region_names) fuzz::require_printable({name});
  require(mesh.region.empty() || mesh.region.size() == mesh.tets.size(), "each tet has its region");
}

void require_printable(const std::vector<Finding>& findings) {
  for (const Finding& finding : findings) fuzz::require_printable({finding.name, finding.message, finding.remedy});
}

void require_lengths(const std::vector<Field>& fields, size_t items) {
  for (const Field& field : fields)
    require(field.values.size() == items * static_cast<size_t>(field.components), "a field has a value per item");
  for (const Field& field : fields) fuzz::require_printable({field.name});
}

}  // namespace

void gmsh(std::string_view bytes) { require_valid(parse_gmsh("file", bytes)); }

void gmsh_slices(std::string_view bytes) {
  constexpr std::int64_t kSlice = 7;
  const std::filesystem::path path = folder_of_process() / "slices.msh";
  put_file(path, bytes);
  const std::optional<GmshSlices> file = GmshSlices::open(path);
  if (!file) return gmsh(bytes);
  MeshContent mesh;
  for (std::int64_t v = 0; v < file->vertex_count(); v += kSlice)
    for (const Vec3d& x : file->vertices(v, std::min(kSlice, file->vertex_count() - v))) mesh.vertices.push_back(x);
  for (std::int64_t t = 0; t < file->tet_count(); t += kSlice)
    for (const Tet& tet : file->tets(t, std::min(kSlice, file->tet_count() - t))) mesh.tets.push_back(tet);
  for (std::int64_t t = 0; file->has_regions() && t < file->tet_count(); ++t) mesh.region.push_back(file->region(t));
  require_valid(mesh);
  const MeshContent whole = parse_gmsh("file", bytes);
  require(whole.vertices.size() == mesh.vertices.size() && whole.tets == mesh.tets && whole.region == mesh.region,
          "slices have the tets of the whole");
  for (size_t v = 0; v < mesh.vertices.size(); ++v)
    require(std::memcmp(&whole.vertices[v], &mesh.vertices[v], sizeof(Vec3d)) == 0,
            "slices have the vertices of the whole");
}

void medit(std::string_view bytes) { require_valid(parse_medit("file", bytes)); }
void obj(std::string_view bytes) { require_valid(parse_obj("file", bytes)); }
void off(std::string_view bytes) { require_valid(parse_off("file", bytes)); }
void ply(std::string_view bytes) {
  require_valid(parse_ply("file", bytes));
  const PaintedSurface painted = parse_painted_ply("file", bytes, "paint");
  require(painted.value.size() == painted.surface.vertices.size(), "each vertex has its value");
  for (const double value : painted.value) require(std::isfinite(value), "values are finite");
}
void stl(std::string_view bytes) { require_valid(parse_stl("file", bytes)); }

void gltf(std::string_view bytes) {
  const ReadBeside none = [](const std::string& name) -> std::string { throw InvalidInput(name + ": is not there"); };
  const MeshContent rest = parse_gltf("file", bytes, none);
  require_valid(rest);
  for (const std::vector<Vec3d>& vertices : parse_gltf_motion("file", bytes, none, {.rate = 24}).vertices) {
    require_finite(vertices);
    require(vertices.size() == rest.vertices.size(), "each sample has the vertices of the mesh");
  }
}

void tetgen(std::string_view bytes) {
  constexpr std::string_view kBetween = "====\n";
  const size_t node_end = std::min(bytes.find(kBetween), bytes.size());
  const std::string_view ele = bytes.substr(std::min(node_end + kBetween.size(), bytes.size()));
  require_valid(parse_tetgen("node", bytes.substr(0, node_end), "ele", ele));
}

namespace {

void require_grid(const Vtu& grid) {
  require_valid({grid.mesh.rest, grid.mesh.tets, grid.mesh.region, {}});
  require_valid({grid.triangles.vertices, {}, {}, grid.triangles.triangles});
  require(grid.mesh.tets.empty() || grid.triangles.triangles.empty(), "tets or triangles");
  require_lengths(grid.point_fields, std::max(grid.mesh.rest.size(), grid.triangles.vertices.size()));
  require_lengths(grid.cell_fields, std::max(grid.mesh.tets.size(), grid.triangles.triangles.size()));
}

}  // namespace

void vtu(std::string_view bytes) { require_grid(parse_vtu(bytes, "file")); }
void vtk(std::string_view bytes) { require_grid(parse_legacy_vtk(bytes, "file")); }

void doctor(std::string_view bytes) {
  constexpr size_t kMax = 2000;  // limit of elements
  if (bytes.starts_with("OFF")) {
    MeshContent content = parse_off("file", bytes);
    TriMesh surface{std::move(content.vertices), std::move(content.triangles)};
    if (surface.triangles.size() > kMax) return;
    require_printable(diagnose(surface));
    fuzz::require_printable(repair(surface));
    require_indices(surface.triangles, surface.vertices.size());
    require_printable(diagnose(surface));
    return;
  }
  MeshContent content = parse_medit("file", bytes);
  TetMesh mesh{std::move(content.vertices), std::move(content.tets), std::move(content.region)};
  if (mesh.tets.size() > kMax) return;
  require_printable(diagnose(mesh));
  quality(mesh);
  fuzz::require_printable(repair(mesh));
  require_indices(mesh.tets, mesh.rest.size());
  boundary_surface(mesh);
}

}  // namespace aspic::fuzz
