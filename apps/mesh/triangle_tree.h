// Searches among the triangles of a surface: the first one that a ray meets, the nearest one, whether a point is
// inside.
#pragma once
#include <vector>

#include "mesh/box_tree.h"
#include "mesh/tet_mesh.h"

namespace aspic {

Vec3d unit_normal(const TriMesh& mesh, int triangle);  // 0 for a triangle without area
double area(const TriMesh& mesh, int triangle);

class TriangleTree {
 public:
  explicit TriangleTree(const TriMesh& mesh);  // keeps a reference to the mesh

  struct Hit {
    double distance = Box::kInfinity;  // in units of the direction
    int triangle = -1;
  };
  // The first crossing at a distance above `beyond`.
  Hit first_hit(const Vec3d& origin, const Vec3d& direction, double beyond) const;

  // Distance to the surface; infinity when it is above `reach`.
  double distance(const Vec3d& x, double reach = Box::kInfinity) const;

  // Whether a ray from x crosses the closed surface an odd number of times, by the majority of three rays.
  bool contains(const Vec3d& x) const;

 private:
  double crossing(int triangle, const Vec3d& origin, const Vec3d& direction) const;

  const TriMesh* mesh_;
  BoxTree tree_;
};

}  // namespace aspic
