#include "results/run_directory_obstacles.h"

#include <filesystem>

#include "contact/barrier.h"
#include "io/mesh_file.h"
#include "io/vtu.h"

namespace aspic {
namespace {

std::vector<ObstacleSurface> obstacles_at(const Barrier* contact, double time) {
  return contact ? obstacle_surfaces(contact->mesh(), contact->obstacle_points(time)) : std::vector<ObstacleSurface>();
}

}  // namespace

RunObstacles::RunObstacles(const RunLayout& layout, const Scene& scene)
    : layout_(layout),
      output_(scene.output),
      contact_(scene.simulation.model().contact),
      start_(obstacles_at(contact_, 0)) {
  for (const ObstacleSurface& obstacle : start_) file_names_.push_back(obstacle.name);
  file_names_ = file_names(file_names_);
}

bool RunObstacles::has_motion() const { return contact_ && contact_->has_moving_obstacle(); }

std::string RunObstacles::file_of(int frame) const {
  if (start_.empty()) return "";
  return has_motion() ? RunLayout::obstacle_frame_file(frame) : RunLayout::obstacle_file();
}

TriMesh RunObstacles::at_frame(size_t obstacle, int frame) const {
  if (!start_[obstacle].is_moving) return start_[obstacle].surface;
  return obstacles_at(contact_, times[frame])[obstacle].surface;
}

void RunObstacles::write_vtu(const std::string& file, const std::vector<ObstacleSurface>& obstacles) const {
  TriMesh all;
  Field number{.name = "obstacle", .type = FieldType::int32};
  for (size_t i = 0; i < obstacles.size(); ++i) {
    const TriMesh& surface = obstacles[i].surface;
    const int first = all.vertex_count();
    all.vertices.insert(all.vertices.end(), surface.vertices.begin(), surface.vertices.end());
    for (const auto& [a, b, c] : surface.triangles) all.triangles.push_back({a + first, b + first, c + first});
    number.values.resize(all.triangles.size(), static_cast<double>(i));
  }
  write_surface_vtu(layout_.root() / file, all, {.cell_fields = {number}});
}

void RunObstacles::write_start() const {
  if (start_.empty()) return;
  const bool has_surfaces = output_.obj || output_.ply || output_.pc2, has_vtu = output_.vtu && !has_motion();
  if (has_surfaces || has_vtu) std::filesystem::create_directories(layout_.obstacles());
  for (size_t i = 0; i < start_.size() && has_surfaces; ++i)
    if (!start_[i].is_moving || output_.pc2) write_mesh(layout_.obstacle(file_names_[i]), start_[i].surface);
  if (has_vtu) write_vtu(RunLayout::obstacle_file(), start_);
}

std::vector<std::filesystem::path> RunObstacles::files_of_frame(int frame) const {
  std::vector<std::filesystem::path> files;
  if (!has_motion()) return files;
  if (output_.vtu) files.push_back(layout_.root() / RunLayout::obstacle_frame_file(frame));
  for (size_t i = 0; i < start_.size() && (output_.obj || output_.ply); ++i)
    if (start_[i].is_moving) files.push_back(layout_.obstacle_frame(file_names_[i], frame));
  return files;
}

void RunObstacles::add_frame(int frame, double time) {
  times.push_back(time);
  const bool has_surfaces = output_.obj || output_.ply;
  if (!has_motion() || !(output_.vtu || has_surfaces)) return;
  const std::vector<ObstacleSurface> now = obstacles_at(contact_, time);
  if (output_.vtu) write_vtu(RunLayout::obstacle_frame_file(frame), now);
  for (size_t i = 0; i < now.size() && has_surfaces; ++i)
    if (now[i].is_moving) write_mesh(layout_.obstacle_frame(file_names_[i], frame), now[i].surface);
}

}  // namespace aspic
