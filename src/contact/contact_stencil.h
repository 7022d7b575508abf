// One term of the barrier energy at given positions.
#pragma once
#include <array>
#include <span>

#include "contact/barrier_function.h"
#include "linalg/projection.h"
#include "mesh/distance.h"

namespace aspic {

struct ContactStencil {
  Distance distance;  // distance of the points below
  // Indices in the ContactMesh: of a point and a triangle, edge or point, or of two edges. A point over a plane stands
  // alone, and its distance is from the plane along the normal.
  std::array<int, 4> point = {-1, -1, -1, -1};
  double weight = 0;      // factor of b [N]
  double reach = 0;       // gap at which b becomes positive [m]
  double offset = 0;      // the gap is the distance minus this [m]
  bool is_round = false;  // of a capsule, a sphere or a rod
  double area = 0;        // signed area that `weight` represents [m^2]; 0: a guard
  std::array<int, 2> parts = {};
  // For two edges: eps in the factor (2 - c/eps) c/eps, which vanishes for parallel edges, where c < eps is the squared
  // norm of their cross product [Li 2020, section 6.2] [m^4]. 0: no factor.
  double parallel = 0;

  bool is_over_plane() const { return point[1] < 0; }
  bool is_of_edges() const { return parallel > 0; }
  double gap() const { return distance.d - offset; }
  BarrierValue b() const { return barrier(gap(), reach); }
  double value(std::span<const Vec3d> x) const;  // [J], for the positions of all points of the mesh
  std::array<Vec3d, 4> gradient(std::span<const Vec3d> x) const;
  // Returns the Hessian. Negative eigenvalues are modified unless `kind` is exact.
  DistanceHessian hessian(std::span<const Vec3d> x, Definiteness kind) const;
};

}  // namespace aspic
