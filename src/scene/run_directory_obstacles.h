// Obstacles in a run directory.
#pragma once
#include "contact/obstacle_surface.h"
#include "scene/run_directory_layout.h"
#include "scene/scene.h"

namespace aspic {

std::vector<ObstacleSurface> obstacles_of(const Scene& scene);  // empty without contact

// Writes obstacles/obstacles.vtu with all obstacles, and an OBJ file of each if surfaces of bodies are wanted.
void write_obstacles(const RunLayout& layout, const Scene& scene);

}  // namespace aspic
