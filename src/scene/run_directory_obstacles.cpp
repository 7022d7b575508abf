#include "scene/run_directory_obstacles.h"

#include <filesystem>

#include "contact/barrier.h"
#include "io/mesh_file.h"
#include "io/vtu.h"

namespace aspic {

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

}  // namespace aspic
