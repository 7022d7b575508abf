// Sag of a body under its own weight.
#pragma once
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

struct SagOptions {
  double young = 1, poisson = 0.4, density = 1000;  // [Pa], [1], [kg/m^3]
  Vec3d gravity{{0, -9.81, 0}};                     // [m/s^2]
};

// Returns the largest displacement [m] of the mesh in linear elasticity, inversely proportional to Young's modulus,
// with the vertices `held` fixed. Parts without such a vertex are ignored. NaN for a mesh with inverted tets or if the
// solve fails.
double sag(TetMesh mesh, std::vector<int> held, const SagOptions& options);

}  // namespace aspic
