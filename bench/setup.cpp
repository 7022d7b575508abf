// Cost of a large scene before its first iteration: a box of N x N x N vertices through every stage of `aspic run` and
// through the mesh formats. CPU time of all threads, present and peak memory. usage: bench_setup [N [FOLDER]]
#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/stopwatch.h"
#include "energy/mass.h"
#include "energy/tet_elasticity.h"
#include "io/mesh_file.h"
#include "mesh/doctor.h"
#include "mesh/generators.h"
#include "mesh/numbering.h"
#include "mesh/surface.h"
#include "scene/run_directory.h"
#include "scene/scene.h"

namespace {

using namespace aspic;
namespace fs = std::filesystem;

double resident_bytes() {
  long pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

double peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024 * static_cast<double>(usage.ru_maxrss);
}

int vertices = 1;
double most_bytes = 0;

void stage(const char* name, const std::function<void()>& work) {
  malloc_trim(0);
  const double before = resident_bytes();
  std::ofstream("/proc/self/clear_refs") << "5";  // resets the peak, if the kernel allows it
  const bench::Stopwatch stopwatch;
  work();
  const double cpu = stopwatch.cpu_seconds(), wall = stopwatch.seconds(), peak = peak_bytes();
  most_bytes = std::max(most_bytes, peak);
  malloc_trim(0);
  std::printf("%-24s %8.2f s %8.2f s wall %8.0f bytes/vertex kept, %8.0f at most\n", name, cpu, wall,
              (resident_bytes() - before) / vertices, (peak - before) / vertices);
  std::fflush(stdout);
}

std::string scene_text(int cells) {
  const std::string n = std::to_string(cells);
  return "[time]\nstep = 0.01\nduration = 0.01\n[solver]\nlinear = \"block_jacobi\"\n[[body]]\nname = \"box\"\n"
         "shape = { box = { upper = [1, 1, 1], cells = [" +
         n + ", " + n + ", " + n +
         "] } }\nmaterial = { model = \"neo_hookean\", young = 1e4, poisson = 0.3, density = 1000 }\n"
         "[[body.pin]]\nwhere = \"x < 1e-9\"\n";
}

void parts(int cells) {
  TetMesh mesh, stored;
  Numbering numbering;
  std::unique_ptr<MassMatrix> mass;
  std::unique_ptr<TetElasticity> elasticity;
  BlockPattern pattern;
  std::optional<BlockSparse> H;
  stage("generator", [&] { mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {cells, cells, cells}); });
  vertices = mesh.vertex_count();
  stage("doctor", [&] { diagnose(mesh); });
  stage("boundary", [&] { boundary_surface(mesh); });
  stage("numbering", [&] { numbering = locality_numbering(mesh); });
  stage("renumbered mesh", [&] { stored = from_user(numbering, mesh); });
  const MaterialParameters soft{.lame = lame_from_young_poisson(1e4, 0.3)};
  stage("mass", [&] {
    mass = std::make_unique<MassMatrix>(stored, std::vector<double>(stored.tets.size(), 1000), MassKind::consistent);
  });
  stage("elasticity",
        [&] { elasticity = make_tet_elasticity("neo_hookean", stored, 0, std::vector(stored.tets.size(), soft)); });
  stage("pattern", [&] {
    Couplings couplings;
    mass->add_couplings(couplings);
    elasticity->add_couplings(couplings);
    pattern = make_pattern(stored.vertex_count(), std::move(couplings));
  });
  stage("bind", [&] { mass->bind(pattern), elasticity->bind(pattern); });
  stage("matrix", [&] { H.emplace(pattern); });
}

void files(int cells, const fs::path& folder) {
  const TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {cells, cells, cells});
  for (const char* name : {"box.mesh", "box.msh", "box.vtu", "box.node"}) {
    stage((std::string("write ") + name).c_str(), [&] { write_mesh(folder / name, mesh); });
    stage((std::string("read ") + name).c_str(), [&] { read_mesh(folder / name); });
  }
  stage("write box.msh, binary", [&] { write_mesh(folder / "box.msh", mesh, FileEncoding::binary); });
  stage("read box.msh, binary", [&] { read_mesh(folder / "box.msh"); });
}

void run(int cells, const fs::path& folder) {
  std::ofstream(folder / "box.toml") << scene_text(cells);
  std::optional<Scene> scene;
  stage("load_scene", [&] { scene.emplace(load_scene(folder / "box.toml")); });
  stage("run directory, frame 0", [&] { RunDirectory::create(folder / "run", *scene, ExistingRun::overwrite); });
}

}  // namespace

int main(int argc, char** argv) {
  const int cells = (argc > 1 ? std::atoi(argv[1]) : 100) - 1;
  const fs::path folder = argc > 2 ? argv[2] : fs::temp_directory_path() / "aspic_bench_setup";
  fs::create_directories(folder);
  parts(cells);
  run(cells, folder);
  files(cells, folder);
  std::printf("%d vertices; most memory of all: %.2f GiB\n", vertices, most_bytes / (1 << 30));
  fs::remove_all(folder);
  return 0;
}
