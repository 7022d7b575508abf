// Flat bodies are stretched along their normal, so that refinement with equal edges gives tets as flat as they are.
#pragma once
#include <optional>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

struct Stretch {
  Vec3d axis{};  // of unit length
  double factor = 1;
};

void stretch(const Stretch& stretch, std::vector<Vec3d>& points);

// The normal of a body that is a plate: nearly all of its surface faces this direction or the opposite one.
std::optional<Vec3d> plate_normal(const TriMesh& body);

}  // namespace aspic
