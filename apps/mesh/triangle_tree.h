// Queries on the triangles of a surface: first intersection with a ray, distance, and inside test.
#pragma once

#include "mesh/box_tree.h"
#include "mesh/tet_mesh.h"

namespace aspic {

Vec3d unit_normal(const TriMesh& mesh, int triangle);  // zero for a triangle without area
double area(const TriMesh& mesh, int triangle);

class TriangleTree {
 public:
  explicit TriangleTree(const TriMesh& mesh);  // stores a reference to the mesh

  struct Hit {
    double distance = Box::kInfinity;  // in units of the direction
    int triangle = -1;
  };
  // First crossing at a distance above `beyond`.
  Hit first_hit(const Vec3d& origin, const Vec3d& direction, double beyond) const;

  // Distance to the surface; infinity if above `reach`.
  double distance(const Vec3d& x, double reach = Box::kInfinity) const;

  // Whether x is inside the closed surface: by a majority of three rays, each with an odd number of crossings.
  bool contains(const Vec3d& x) const;

 private:
  double crossing(int triangle, const Vec3d& origin, const Vec3d& direction) const;

  const TriMesh* mesh_;
  BoxTree tree_;
};

}  // namespace aspic
