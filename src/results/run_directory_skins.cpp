#include "results/run_directory_skins.h"

#include <algorithm>
#include <filesystem>

#include "io/mesh_file.h"

namespace aspic {
namespace {

std::vector<std::string> names_of(const std::vector<Skin>& skins) {
  std::vector<std::string> names;
  for (const Skin& skin : skins) names.push_back(skin.body);
  return file_names(names);
}

TriMesh moved(const TriMesh& rest, const std::vector<double>& x) {
  TriMesh mesh = rest;
  for (size_t i = 0; i < x.size(); ++i) mesh.vertices[i / 3][static_cast<int>(i % 3)] = x[i];
  return mesh;
}

std::vector<float> flat(const std::vector<Vec3d>& points) {
  std::vector<float> numbers;
  for (const Vec3d& x : points) numbers.insert(numbers.end(), x.a, x.a + 3);
  return numbers;
}

void write_skin(const std::filesystem::path& path, const TriMesh& mesh, const Skin& skin) {
  if (!skin.uv.empty() && path.extension() == ".obj") return write_textured_mesh(path, mesh, skin.uv);
  if (skin.segments.empty())
    return write_mesh(path, mesh, path.extension() == ".ply" ? FileEncoding::binary : FileEncoding::ascii);
  TetMesh lines{.rest = mesh.vertices, .tets = {}, .region = {}};
  lines.rods = skin.segments;
  write_line_mesh(path, lines);
}

}  // namespace

RunSkins::RunSkins(const RunLayout& layout, const Scene& scene)
    : layout_(layout),
      output_(scene.output),
      skins_(scene.skins),
      names_(names_of(scene.skins)),
      frame_rate_(1 / std::max(scene.output.every, scene.simulation.options().h)),
      up_(up_axis(scene.gravity)) {}

RunSkins RunSkins::create(const RunLayout& layout, const Scene& scene) {
  RunSkins skins(layout, scene);
  for (size_t i = 0; i < skins.skins_.size(); ++i) {
    if (!skins.output_.pc2 && !skins.output_.usd) break;
    const TriMesh& rest = skins.skins_[i].rest;
    write_skin(layout.skin_rest(skins.names_[i]), rest, skins.skins_[i]);
    skins.caches_.push_back(Pc2File::create(layout.skin_cache(skins.names_[i]), rest.vertex_count()));
  }
  return skins;
}

RunSkins RunSkins::resume(const RunLayout& layout, const Scene& scene, int frames) {
  RunSkins skins(layout, scene);
  for (size_t i = 0; i < skins.skins_.size(); ++i) {
    if (!skins.output_.pc2 && !skins.output_.usd) break;
    write_skin(layout.skin_rest(skins.names_[i]), skins.skins_[i].rest, skins.skins_[i]);
    skins.caches_.push_back(
        Pc2File::resume(layout.skin_cache(skins.names_[i]), skins.skins_[i].rest.vertex_count(), frames));
  }
  return skins;
}

void RunSkins::add_frame(int frame, std::span<const double> q) {
  for (size_t i = 0; i < skins_.size(); ++i) {
    x_.resize(3 * static_cast<size_t>(skins_[i].rest.vertex_count()));
    carry(skins_[i].embedding, q, x_);
    if (!caches_.empty()) caches_[i].append(x_);
    if (!output_.obj && !output_.ply) continue;
    const TriMesh mesh = moved(skins_[i].rest, x_);
    if (output_.obj) write_skin(layout_.skin_frame(names_[i], frame, ".obj"), mesh, skins_[i]);
    if (output_.ply) write_skin(layout_.skin_frame(names_[i], frame, ".ply"), mesh, skins_[i]);
  }
}

std::vector<std::filesystem::path> RunSkins::files_of_frame(int frame) const {
  std::vector<std::filesystem::path> files;
  for (const std::string& name : names_) {
    if (output_.obj) files.push_back(layout_.skin_frame(name, frame, ".obj"));
    if (output_.ply) files.push_back(layout_.skin_frame(name, frame, ".ply"));
  }
  return files;
}

std::vector<double> RunSkins::checksums() const {
  std::vector<double> sums;
  for (const Pc2File& cache : caches_) sums.push_back(cache.checksum());
  return sums;
}

void RunSkins::require_unchanged(const std::vector<double>& checksums) const {
  for (size_t i = 0; i < std::min(caches_.size(), checksums.size()); ++i)
    aspic::require_unchanged(layout_.skin_cache(names_[i]), checksums[i], caches_[i].checksum());
}

void RunSkins::sync() {
  for (Pc2File& cache : caches_) cache.sync();
}

void RunSkins::write_usd(const std::vector<double>& frame_times, const RunObstacles& obstacles) {
  if (!output_.usd || skins_.empty()) return;
  std::vector<UsdMesh> meshes;
  for (size_t i = 0; i < skins_.size(); ++i) {
    meshes.push_back({.name = skins_[i].body,
                      .triangles = skins_[i].rest.triangles,
                      .points = [this, i](int frame) { return caches_[i].sample(frame); },
                      .is_two_sided = skins_[i].is_sheet,
                      .segments = skins_[i].segments,
                      .radius = skins_[i].radius,
                      .uv = skins_[i].uv});
  }
  for (size_t i = 0; i < obstacles.at_start().size(); ++i) {
    const ObstacleSurface& start = obstacles.at_start()[i];
    meshes.push_back({.name = start.name,
                      .triangles = start.surface.triangles,
                      .points = [&obstacles, i](int frame) { return flat(obstacles.at_frame(i, frame).vertices); },
                      .is_fixed = !start.is_moving});
  }
  aspic::write_usd(layout_.usd(), meshes, frame_times, frame_rate_, {up_});
  frames_in_usd_ = frame_times.size();
}

void RunSkins::write_usd_when_doubled(const std::vector<double>& frame_times, const RunObstacles& obstacles) {
  if (frame_times.size() >= 2 * frames_in_usd_) write_usd(frame_times, obstacles);
}

void RunSkins::close() {
  for (Pc2File& cache : caches_) cache.close();
}

}  // namespace aspic
