// Finds the scenes of the lecture and the real mesh, without machine-specific paths.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <system_error>

#include "aspic/lecture/course.h"
#include "aspic/shipped_files.h"
#include "base/error.h"
#include "io/mesh_file.h"
#include "io/tetrahedralize.h"
#include "mesh/box.h"
#include "scene/scene_files.h"

namespace aspic::cli::lecture {
namespace {

namespace fs = std::filesystem;

double largest_extent(const std::vector<Vec3d>& X, const fs::path& path) {
  if (X.empty()) throw InvalidInput(path.string() + ": has no vertices");
  const double extent = longest_side(bounding_box(X));
  if (!(extent > 0) || !std::isfinite(extent)) throw InvalidInput(path.string() + ": has no extent");
  return extent;
}

double extent_of(const fs::path& path) {
  return std::visit(
      [&](const auto& mesh) {
        if constexpr (std::is_same_v<std::decay_t<decltype(mesh)>, TetMesh>)
          return largest_extent(mesh.rest, path);
        else
          return largest_extent(mesh.vertices, path);
      },
      read_mesh(path));
}

bool holds_tets(const fs::path& path) { return std::holds_alternative<TetMesh>(read_mesh(path)); }

// Fills the surface with tets, once; the stored name contains surface and size.
fs::path filled(const fs::path& surface, double size, const fs::path& cache) {
  const std::string hash = fingerprint_of_file(surface);
  const fs::path kept =
      cache / fmt::format("{}_{}_{:.4g}.mesh", surface.stem().string(), hash.substr(hash.find(':') + 1), size);
  std::error_code error;
  if (fs::exists(kept, error)) return kept;
  fs::create_directories(cache, error);
  write_mesh(kept, tetrahedralize(surface, {.size = size}).tets);
  return kept;
}

// Overrides that replace the bodies' meshes by this mesh, scaled to one meter.
std::vector<std::string> overrides_for(const fs::path& mesh) {
  if (mesh.empty()) return {};
  return {"mesh=" + toml_string(mesh.string()), fmt::format("scale={}", 1 / extent_of(mesh))};
}

}  // namespace

Stage::Stage(const fs::path& mesh, fs::path cache) : scenes_(shipped_file("scenes/lecture")), cache_(std::move(cache)) {
  if (scenes_.empty())
    throw InvalidInput(
        "the lecture's scenes are not found: there is no scenes/lecture in this folder, beside the program or in a "
        "folder above them; start in the folder of Aspic's sources, or install it");
  if (!mesh.empty()) {
    const fs::path path = fs::absolute(mesh);
    if (!holds_tets(path)) surface_ = path;
    mesh_ = surface_.empty() ? path : filled(surface_, 0, cache_);
    note_ = "real mesh: " + mesh.string() + ", made one meter large";
    return;
  }
  surface_ = shipped_file("scenes/bunny.obj");
  mesh_ = shipped_file("scenes/bunny.mesh");
  if (mesh_.empty() && !surface_.empty()) {
    try {
      mesh_ = filled(surface_, 0, cache_);
    } catch (const InvalidInput& error) {  // aspic-mesh is missing
      note_ = std::string(error.what()) + "; ";
    }
  }
  note_ = mesh_.empty() ? note_ +
                              "no real mesh: scenes/bunny.mesh is not found, nor was --mesh given; "
                              "each scene keeps the shape that it describes"
                        : "real mesh: the bunny, made one meter large";
}

Scene Stage::scene(const std::string& name, const std::vector<std::string>& overrides) const {
  return load(name, {}, overrides);
}

Scene Stage::on_real_mesh(const std::string& name, const std::vector<std::string>& overrides) const {
  return load(name, mesh_, overrides);
}

Scene Stage::on_fine_mesh(const std::string& name, int tets, Sheet& sheet) const {
  fs::path fine;
  try {
    fine = finer(tets);
  } catch (const InvalidInput& error) {  // aspic-mesh is missing, or it refuses the surface
    sheet.remark(error.what());
  }
  if (!fine.empty()) return load(name, fine, {});
  if (!mesh_.empty()) sheet.remark("the real mesh has fewer tets and no surface is known to fill: a generated ring");
  // A ring has about 35 tets per cube of its edge length in 0.2 m^3; its description is refined accordingly.
  for (double size = 0.025;; size *= 0.8) {
    Scene scene = load(name, {}, {fmt::format("body.0.shape.torus.size={}", size)});
    if (scene.simulation.model().mesh.tet_count() >= tets) return scene;
  }
}

// The real mesh if fine enough, or its surface filled with smaller tets; empty if neither exists.
fs::path Stage::finer(int tets) const {
  if (mesh_.empty()) return {};
  const TetMesh mesh = read_tet_mesh(mesh_);
  if (mesh.tet_count() >= tets) return mesh_;
  if (surface_.empty()) return {};
  double volume = 0;
  for (int t = 0; t < mesh.tet_count(); ++t) volume += aspic::volume(mesh, t);
  // A tet of edge a has the volume a^3 / (6 sqrt 2); meshes have slightly larger ones for the same target.
  double size = std::cbrt(volume / tets * 6 * std::sqrt(2.0)) * 0.9;
  for (;; size *= 0.85) {
    const fs::path fine = filled(surface_, size, cache_);
    if (read_tet_mesh(fine).tet_count() >= tets) return fine;
  }
}

Scene Stage::load(const std::string& name, const fs::path& mesh, std::vector<std::string> overrides) const {
  const std::vector<std::string> first = overrides_for(mesh);
  overrides.insert(overrides.begin(), first.begin(), first.end());
  return load_scene(path_of(name), {.overrides = overrides, .allow_outside = true});
}

fs::path Stage::path_of(const std::string& name) const { return scenes_ / (name + ".toml"); }

std::vector<std::string> Stage::real_mesh() const { return overrides_for(mesh_); }

}  // namespace aspic::cli::lecture
