// Surfaces of obstacles, for pictures and files.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "contact/contact_mesh.h"

namespace aspic {

struct ObstacleSurface {
  std::string name;
  bool is_moving = false;
  TriMesh surface;                    // now [m]; of a plane: a square below the bodies
  std::optional<ContactPlane> plane;  // nothing: a surface
};

// In the order of the scene.
std::vector<ObstacleSurface> obstacle_surfaces(const ContactMesh& mesh);

}  // namespace aspic
