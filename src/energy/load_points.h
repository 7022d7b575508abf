// Quadrature of loads on tets and faces: exact for uniform loads.
#pragma once
#include <span>
#include <vector>

#include "mesh/surface.h"
#include "mesh/tet_mesh.h"

namespace aspic {

// A point at which a load is evaluated: the force on node n is size shares[n] times the load.
struct LoadPoint {
  Vec3d position;              // [m]
  Vec3d normal{};              // outward, of any length; only on faces
  std::vector<int> nodes;      // vertices of the mesh
  double size;                 // [m^3] or [m^2]
  std::vector<double> shares;  // times size: integrals of the shape functions over the part of the point
};

// One point per linear element, and points of degree 2 in quadratic ones.
void append_load_points(const TetMesh& mesh, int tet, std::vector<LoadPoint>& points);
void append_load_points(const std::vector<Vec3d>& rest, const Face& face, std::vector<LoadPoint>& points);

// Adds the forces of a load at the point to `force`, 3 per vertex [N]. `load`: [N/m^3] or [Pa].
void add_load(const LoadPoint& point, const Vec3d& load, std::span<double> force);

}  // namespace aspic
