// How far a body sinks under its own weight.
#pragma once
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

struct SagOptions {
  double young = 1, poisson = 0.4, density = 1000;  // [Pa], [1], [kg/m^3]
  Vec3d gravity{{0, -9.81, 0}};                     // [m/s^2]
};

// The largest displacement of the mesh, fixed at the vertices `held`, in linear elasticity, where it is inversely
// proportional to Young's modulus [m]. Parts that hold none of these vertices do not count. NaN where there is
// none, and for a mesh with inverted tets.
double sag(TetMesh mesh, std::vector<int> held, const SagOptions& options);

}  // namespace aspic
