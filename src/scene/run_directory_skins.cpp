#include "scene/run_directory_skins.h"

#include <algorithm>
#include <filesystem>

#include "contact/barrier.h"
#include "io/mesh_file.h"
#include "io/usd.h"
#include "io/vtu.h"

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

}  // namespace

std::vector<ObstacleSurface> obstacles_of(const Scene& scene) {
  const Barrier* contact = scene.simulation.model().contact;
  return contact ? obstacle_surfaces(contact->mesh(), contact->obstacle_points(0)) : std::vector<ObstacleSurface>();
}

void write_obstacles(const RunLayout& layout, const Scene& scene) {
  const std::vector<ObstacleSurface> obstacles = obstacles_of(scene);
  if (obstacles.empty()) return;
  std::filesystem::create_directories(layout.obstacles());
  std::vector<std::string> names;
  for (const ObstacleSurface& obstacle : obstacles) names.push_back(obstacle.name);
  names = file_names(names);
  TriMesh all;
  Field number{.name = "obstacle", .type = FieldType::int32};
  for (size_t i = 0; i < obstacles.size(); ++i) {
    const TriMesh& surface = obstacles[i].surface;
    if (scene.output.obj || scene.output.ply || scene.output.pc2) write_mesh(layout.obstacle(names[i]), surface);
    const int first = all.vertex_count();
    all.vertices.insert(all.vertices.end(), surface.vertices.begin(), surface.vertices.end());
    for (const auto& [a, b, c] : surface.triangles) all.triangles.push_back({a + first, b + first, c + first});
    number.values.resize(all.triangles.size(), static_cast<double>(i));
  }
  if (scene.output.vtu) write_surface_vtu(layout.root() / RunLayout::obstacle_file(), all, {.cell_fields = {number}});
}

RunSkins::RunSkins(const RunLayout& layout, const Scene& scene)
    : layout_(layout),
      output_(scene.output),
      skins_(scene.skins),
      names_(names_of(scene.skins)),
      contact_(scene.simulation.model().contact),
      obstacles_(obstacles_of(scene)),
      frame_rate_(1 / std::max(scene.output.every, scene.simulation.options().h)) {}

RunSkins RunSkins::create(const RunLayout& layout, const Scene& scene) {
  RunSkins skins(layout, scene);
  for (size_t i = 0; i < skins.skins_.size(); ++i) {
    if (!skins.output_.pc2 && !skins.output_.usd) break;
    const TriMesh& rest = skins.skins_[i].rest;
    write_mesh(layout.skin_rest(skins.names_[i]), rest);
    skins.caches_.push_back(Pc2File::create(layout.skin_cache(skins.names_[i]), rest.vertex_count()));
  }
  return skins;
}

RunSkins RunSkins::resume(const RunLayout& layout, const Scene& scene, int frames) {
  RunSkins skins(layout, scene);
  for (size_t i = 0; i < skins.skins_.size(); ++i) {
    if (!skins.output_.pc2 && !skins.output_.usd) break;
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
    if (output_.obj) write_mesh(layout_.skin_frame(names_[i], frame, ".obj"), mesh);
    if (output_.ply) write_mesh(layout_.skin_frame(names_[i], frame, ".ply"), mesh, FileEncoding::binary);
  }
}

void RunSkins::sync() {
  for (Pc2File& cache : caches_) cache.sync();
}

void RunSkins::write_usd(const std::vector<double>& frame_times) {
  if (!output_.usd || skins_.empty()) return;
  std::vector<UsdMesh> meshes;
  for (size_t i = 0; i < skins_.size(); ++i) {
    meshes.push_back({.name = skins_[i].body, .triangles = skins_[i].rest.triangles, .points = [this, i](int frame) {
                        return caches_[i].sample(frame);
                      }});
  }
  for (size_t i = 0; i < obstacles_.size(); ++i)
    meshes.push_back({.name = obstacles_[i].name,
                      .triangles = obstacles_[i].surface.triangles,
                      .points =
                          [&, i](int frame) {
                            if (!obstacles_[i].is_moving) return flat(obstacles_[i].surface.vertices);
                            const auto points = contact_->obstacle_points(frame_times[frame]);
                            return flat(obstacle_surfaces(contact_->mesh(), points)[i].surface.vertices);
                          },
                      .is_fixed = !obstacles_[i].is_moving});
  aspic::write_usd(layout_.usd(), meshes, frame_times, frame_rate_);
  frames_in_usd_ = frame_times.size();
}

void RunSkins::write_usd_when_doubled(const std::vector<double>& frame_times) {
  if (frame_times.size() >= 2 * frames_in_usd_) write_usd(frame_times);
}

void RunSkins::close() {
  for (Pc2File& cache : caches_) cache.close();
}

}  // namespace aspic
