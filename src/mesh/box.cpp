#include "mesh/box.h"

namespace aspic {

Box bounding_box(const std::vector<Vec3d>& X) {
  Box box;
  for (const Vec3d& P : X) box.add(P);
  return box;
}

double longest_side(const Box& box) {
  const Vec3d size = box.upper - box.lower;
  return std::max({size[0], size[1], size[2]});
}

double size_of(const TetMesh& mesh) {
  const Box box = bounding_box(mesh.rest);
  return norm(box.upper - box.lower);
}

}  // namespace aspic
