// Closest points on a surface.
#pragma once
#include <array>
#include <span>

#include "mesh/box_tree.h"
#include "mesh/tet_mesh.h"

namespace aspic {

struct ClosestPoint {
  int triangle = 0;
  std::array<double, 3> weights{};  // barycentric, sum to 1
  Vec3d position{};                 // [m]
  double distance = 0;              // [m]
};

class SurfaceLocator {
 public:
  // Keeps references to both. Requires at least one triangle and finite coordinates.
  SurfaceLocator(std::span<const Vec3d> vertices, std::span<const Triangle> triangles);

  // Returns the closest point; of several triangles at the same distance, the first.
  ClosestPoint nearest(const Vec3d& p) const;

 private:
  std::span<const Vec3d> vertices_;
  std::span<const Triangle> triangles_;
  BoxTree tree_;
};

}  // namespace aspic
