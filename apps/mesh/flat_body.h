// Flat bodies are stretched along their normal, so that refinement with equal edges gives correspondingly flat tets.
#pragma once
#include <optional>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

struct Stretch {
  Vec3d axis{};  // unit vector
  double factor = 1;
};

void stretch(const Stretch& stretch, std::vector<Vec3d>& points);

// Returns the normal of a plate: a body whose surface mostly faces one direction or the opposite one.
std::optional<Vec3d> plate_normal(const TriMesh& body);

}  // namespace aspic
