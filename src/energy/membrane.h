// In-plane elasticity of thin sheets: V(x) = sum over triangles of area * thickness * psi(C), C = F'F (2x2), with the
// constant deformation gradient F (3x2) of the rest plane.
#pragma once
#include <array>
#include <limits>
#include <memory>
#include <variant>
#include <vector>

#include "energy/energy.h"
#include "mesh/tet_mesh.h"

namespace aspic {

using PlaneVector = std::array<double, 2>;  // in the rest plane of a triangle

// A triangle of a sheet and its rest shape.
struct SheetTriangle {
  Triangle corners;                    // vertices of the mesh
  std::array<double, 4> rest_inverse;  // [X1 - X0, X2 - X0]^-1 in the rest plane, column-major [1/m]
  double area;                         // at rest [m^2]
};

// Return the triangle with the given rest positions of its corners [m]. Both require a positive area. In space, the
// first axis of the rest plane is the edge from corner 0 to corner 1, and corner 2 has a positive second coordinate. A
// flat pattern may differ between triangles that share an edge, as at darts and seams.
SheetTriangle make_sheet_triangle(const Triangle& corners, const std::array<Vec3d, 3>& rest);
SheetTriangle make_sheet_triangle(const Triangle& corners, const std::array<PlaneVector, 3>& pattern);

// Returns the unit vector of the projection of a direction on the rest plane, in the axes of make_sheet_triangle();
// {1, 0} for the normal of the plane.
PlaneVector direction_in_plane(const std::array<Vec3d, 3>& rest, const Vec3d& direction);

// Limit of the principal stretches s. It adds to the density of a sheet, for each s > from,
//   -k (s - from)^2 ln((to - s) / (to - from)),  +inf from s = to on.
struct StretchLimit {
  double from = 1, to = std::numeric_limits<double>::infinity();  // 1 <= from < to; infinite: no limit
  double stiffness = 0;                                           // k [Pa]
};

// Neo-Hookean sheet in plane stress, exact for small strains; +inf for a collapsed triangle:
//   psi = mu/2 (tr C - 2 - 2 ln J) + la/2 (ln J)^2,  J^2 = det C,  mu = E / (2 (1 + nu)),  la = E nu / (1 - nu^2)
struct IsotropicSheet {
  double young;      // E [Pa]
  double poisson;    // nu, in [0, 1)
  double thickness;  // [m]
  StretchLimit limit = {};
};

// St. Venant-Kirchhoff sheet with the constants of woven fabrics. It is finite for a collapsed triangle:
//   psi = (Q1 E11^2 + Q2 E22^2) / 2 + Q12 E11 E22 + 2 G E12^2,  E = (C - I) / 2,  axis 1 along the warp
//   Q1 = E1 / (1 - nu12 nu21),  Q2 = E2 / (1 - nu12 nu21),  Q12 = nu12 Q2,  nu21 = nu12 E2 / E1
struct OrthotropicSheet {
  double warp_young, weft_young;  // E1, E2 [Pa]
  double poisson;                 // nu12: contraction along the weft for a stretch along the warp; nu12 nu21 < 1
  double shear;                   // G [Pa]
  double thickness;               // [m]
  PlaneVector warp = {1, 0};      // direction of the warp in the rest plane, a unit vector
  StretchLimit limit = {};
};

using MembraneLaw = std::variant<IsotropicSheet, OrthotropicSheet>;

// Fields per triangle, in the order of the list.
struct MembraneFields {
  std::vector<std::array<double, 2>> stretch;  // principal stretches, the larger one first [1]
  std::vector<double> energy_density;          // thickness * psi [J/m^2 of the rest area]
  // Principal in-plane Cauchy stresses, the larger one first [Pa]: the force per current length of a cut, divided by
  // the rest thickness. Not finite in a collapsed triangle.
  std::vector<std::array<double, 2>> stress;
};

class Membrane : public SteadyEnergy {
 public:
  virtual void evaluate(Positions x, MembraneFields& fields) const = 0;  // resizes the fields
};

// Requires one law per triangle.
std::unique_ptr<Membrane> make_membrane(const std::vector<SheetTriangle>& triangles,
                                        const std::vector<MembraneLaw>& laws);

}  // namespace aspic
