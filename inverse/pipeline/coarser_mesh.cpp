#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "data/synthesis.h"
#include "io/external_program.h"
#include "io/mesh_file.h"
#include "io/tetrahedralize.h"
#include "mesh/surface.h"
#include "scene/body_mesh.h"
#include "scene/toml_reader.h"

namespace aspic {
namespace {

constexpr double kCoarser = 1.5;  // ratio of edges. Chosen

// Lengthens the edges of a resolved shape.
void coarsen(Value& shape) {
  Member& kind = shape.table().members.front();  // box, cylinder, ...
  Table& table = kind.value.table();
  if (Value* size = table.find("size")) size->data = kCoarser * size->number();
  if (Value* cells = table.find("cells"))
    for (Value& count : cells->array()) count.data = std::max<std::int64_t>(1, std::llround(count.number() / kCoarser));
}

TetMesh generated_coarser(Value body, const std::filesystem::path& mesher, std::vector<std::string>& notes) {
  coarsen(*body.table().find("shape"));
  std::erase_if(body.table().members, [](const Member& m) { return m.key == "mesh_hash" || m.key == "skin"; });
  SceneFiles files(".", true);
  MeshLoader loader{files, mesher, notes, {}, {}, 0};
  return make_body_mesh(body, loader, std::nullopt).tets;
}

// Edge length of a regular tet with the mean volume.
double edge_length(const TetMesh& mesh) {
  double sum = 0;
  for (int t = 0; t < mesh.tet_count(); ++t) sum += volume(mesh, t);
  return std::cbrt(6 * std::sqrt(2.0) * sum / mesh.tet_count());
}

TetMesh filled_coarser(const TetMesh& mesh, const std::filesystem::path& mesher) {
  const TemporaryFolder folder;
  const std::filesystem::path surface = folder.path() / "surface.off";
  write_mesh(surface, boundary_surface(mesh).surface);
  return tetrahedralize(surface, {.size = kCoarser * edge_length(mesh), .program = mesher}).tets;
}

}  // namespace

std::optional<TetMesh> coarser_mesh(const Scene& scene, const std::filesystem::path& mesher,
                                    std::vector<std::string>& notes) {
  const Model& model = scene.simulation.model();
  const Value body = read_toml(scene.resolved, scene.name).find("body")->array().front();
  try {
    TetMesh mesh = body.find("shape") ? generated_coarser(body, mesher, notes) : filled_coarser(model.mesh, mesher);
    if (mesh.tet_count() < model.mesh.tet_count()) return mesh;
    notes.push_back("no coarser mesh than that of the scene was possible");
  } catch (const InvalidInput& e) {
    notes.push_back(std::string("no coarser mesh was possible: ") + e.what());
  }
  return std::nullopt;
}

}  // namespace aspic
