// Quadrature of loads on tets and faces.
#pragma once
#include <array>
#include <span>

#include "base/function_ref.h"
#include "mesh/surface.h"
#include "mesh/tet_mesh.h"

namespace aspic {

// A tet or a face under a load.
struct LoadElement {
  std::array<int, 10> node{};  // vertices of the mesh: corners first
  int corner_count = 0, node_count = 0;
  std::array<Vec3d, 4> corner{};  // [m]
  Vec3d normal{};                 // outward, of any length; only of faces
  double size = 0;                // [m^3] or [m^2]
};

LoadElement load_element(const TetMesh& mesh, int tet);
LoadElement load_element(const std::vector<Vec3d>& rest, const Face& face);

// Adds the forces of a load, the integrals of load(X) times the shape functions, to `force`, 3 per vertex [N]. Exact
// for polynomials in X: of degree 3 on linear faces and quadratic tets, 2 on quadratic faces, 4 on linear tets. load:
// [N/m^3] or [Pa].
void add_load(const LoadElement& element, FunctionRef<Vec3d(const Vec3d& X)> load, std::span<double> force);

}  // namespace aspic
