// Readers of folders: scenes with their meshes, runs, materials.
#include <cmath>
#include <filesystem>
#include <string>

#include "base/stop_token.h"
#include "io/checkpoint.h"
#include "io/mesh_file.h"
#include "io/pc2.h"
#include "io/ply.h"
#include "mesh/generators.h"
#include "mesh/surface.h"
#include "results/run_directory.h"
#include "run_files.h"
#include "scene/material_file.h"
#include "scene/scene.h"
#include "scene/tables.h"
#include "several_files.h"
#include "targets.h"

namespace aspic::fuzz {
namespace {

namespace fs = std::filesystem;

TetMesh small_box() { return make_box({{0, 0, 0}}, {{1, 1, 1}}, {1, 1, 1}); }

// Files that scenes of the corpus refer to.
fs::path folder_with_meshes() {
  static const fs::path folder = [] {
    const fs::path& path = folder_of_process();
    TetMesh mesh = small_box();
    mesh.region = {1, 1, 1, 2, 2, 2};
    write_mesh(path / "box.msh", mesh);
    const TriMesh skin = boundary_surface(mesh).surface;
    write_mesh(path / "skin.obj", skin);
    std::vector<double> x;
    for (const Vec3d& X : skin.vertices) x.insert(x.end(), X.a, X.a + 3);
    Pc2File::create(path / "skin.pc2", skin.vertex_count()).append(x);
    std::string painted = ply_bytes(skin, FileEncoding::ascii);
    painted.insert(painted.find("element face"), "property double paint\n");
    for (size_t line = painted.find("end_header"), v = 0; v < skin.vertices.size(); ++v)
      line = painted.find('\n', line + 1), painted.insert(painted.find('\n', line + 1), v % 2 ? " 1" : " 0.2");
    put_file(path / "painted.ply", painted);
    put_file(path / "young.csv", "1e5\n1e5\n1e5\n2e5\n2e5\n2e5\n");
    write_material(path / "material.vtu",
                   {.mesh = mesh,
                    .model = "neo_hookean",
                    .values = {{"young", std::vector<double>(6, 1e5)}, {"poisson", std::vector<double>(6, 0.4)}}});
    return path;
  }();
  return folder;
}

}  // namespace

void scene(std::string_view bytes) {
  const fs::path path = folder_with_meshes() / "scene.toml";
  put_file(path, bytes);
  const Scene built = load_scene(path, small_scenes());
  require(built.simulation.model().mesh.element_count() <= kMaxTets,
          "the scene has at most the maximum number of elements");
  require(built.steps >= 0, "the number of steps is not negative");
  for (const double q : built.simulation.state().q) require(std::isfinite(q), "positions are finite");
  require_printable(built.notes);
  for (const BodyRange& body : built.simulation.model().bodies) require_printable({body.name});
}

// Takes the steps of a scene, each until it has polled the token a few times.
void run_briefly(const fs::path& path) {
  constexpr int kMaxPolls = 40;
  Scene built = load_scene(path, small_scenes());
  require_printable(built.notes);
  int polls = 0;
  const StopToken stop([&polls] { return ++polls > kMaxPolls; });
  for (int i = 0; i < built.steps; ++i) built.simulation.step({}, stop);
  for (const double q : built.simulation.state().q) require(std::isfinite(q), "positions are finite");
}

// A box falls onto the surface in the file.
void obstacle(std::string_view bytes) {
  const fs::path folder = folder_of_process();
  put_file(folder / "obstacle.obj", bytes);
  put_file(
      folder / "falling.toml",
      "[time]\nduration = 0.02\n[contact]\nfriction = 0.5\n[[body]]\nvelocity = [0, -9, 0]\nshape = { box = { lower = "
      "[0, 0.05, 0], upper = [1, 1, 1], cells = [1, 1, 1] } }\n[[obstacle]]\nmesh = \"obstacle.obj\"\n");
  run_briefly(folder / "falling.toml");
}

void thin(std::string_view bytes) {
  const fs::path folder = folder_of_process();
  put_file(folder / "thin.obj", bytes);
  const bool is_rod = bytes.find("\nl ") != std::string_view::npos;
  put_file(
      folder / "thin.toml",
      std::string("[time]\nduration = 0.02\n[contact]\nfriction = 0.5\n[[obstacle]]\nplane = { origin = [0, -1, 0] "
                  "}\n[[body]]\nmesh = \"thin.obj\"\n") +
          (is_rod ? "rod = { radius = 1e-2 }\n" : "shell = { thickness = 1e-2 }\n"));
  run_briefly(folder / "thin.toml");
}

void material(std::string_view bytes) {
  const fs::path path = folder_of_process() / "fuzzed.vtu";
  put_file(path, bytes);
  const FittedMaterial fitted = read_material(path);
  for (const auto& [name, values] : fitted.values)
    require(values.size() == fitted.mesh.tets.size(), "a quantity has a value per tet");
  if (fitted.mesh.tets.empty() || fitted.values.empty()) return;
  const Vec3d places[] = {{{0, 0, 0}}, {{0.3, 0.3, 0.3}}, {{1e9, 0, -1e9}}};
  for (const int tet : sampling(fitted, places).tet)
    require(tet >= 0 && tet < fitted.mesh.tet_count(), "an index of a tet is in range");
}

void run_folder(std::string_view bytes) {
  static const Folder begun = begun_run(0);
  const fs::path run = folder_of_process() / "run";
  begun.restore(run);
  const Files files(run, bytes,
                    {"checkpoint.bin", "steps.csv", "iterations.csv", "timings.csv", "scene.toml", "run.pvd"});
  Scene again = load_scene(scene_of_run(run), small_scenes());
  make_checkpoint_right(run / "checkpoint.bin", fingerprint(again.resolved));
  RunDirectory resumed = RunDirectory::resume(run, again);
  require(again.simulation.steps_taken() >= 0, "the number of steps of a resumed run is not negative");
}

void values(std::string_view bytes) {
  const fs::path path = folder_of_process() / "values.csv";
  put_file(path, bytes);
  const size_t columns = bytes.empty() ? 1 : 1 + static_cast<unsigned char>(bytes[0]) % 3;
  require(read_number_table(path, columns, 2, "a tet", {}).size() == 2 * columns, "a table has the expected size");
}

}  // namespace aspic::fuzz
