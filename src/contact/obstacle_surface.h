// Surfaces of obstacles for rendering and files.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "contact/contact_mesh.h"

namespace aspic {

struct ObstacleSurface {
  std::string name;
  bool is_moving = false;
  TriMesh surface;                    // current positions [m]; a plane: a square below the bodies
  std::optional<ContactPlane> plane;  // empty: not a plane
};

// Returns the surfaces in the order of the scene. `points`: positions of the points of the mesh, see
// Barrier::obstacle_points().
std::vector<ObstacleSurface> obstacle_surfaces(const ContactMesh& mesh, std::span<const Vec3d> points);

}  // namespace aspic
