// Bending of thin sheets: V(x) = sum over inner edges of D l^2 / (2 (A1 + A2)) (theta - theta0)^2, where theta is the
// angle between the two triangles at the edge, l its length and A1, A2 the areas of the triangles at rest. Exact for
// cylinders on a mesh with edges along the axis and right angles; the stiffness of other shapes depends on the mesh.
//
// An edge may have triangles of any orientation. An edge of three or more triangles has a hinge between each two that
// are neighbors around it at rest, except between two that lie on each other.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "energy/energy.h"
#include "mesh/tet_mesh.h"

namespace aspic {

// theta0: 0, or the angle of the rest shape. Edges of three or more triangles always use the latter.
enum class RestAngles { flat, of_rest };

class HingeBending : public SteadyEnergy {
 public:
  // Writes the energy per area of each triangle at rest [J/m^2]; resizes the list. An edge gives half of its energy to
  // each of its triangles.
  virtual void evaluate(Positions x, std::vector<double>& energy_density) const = 0;
};

// `rest`: X of all vertices [m]. `moment`: D = E t^3 / (12 (1 - nu^2)) of each triangle [N m]; an edge uses the mean
// weighted by area. V is +inf where a triangle with a hinge is collapsed. Requires positive areas at rest.
std::unique_ptr<HingeBending> make_hinge_bending(std::span<const Vec3d> rest, std::span<const Triangle> triangles,
                                                 std::span<const double> moment, RestAngles rest_angles);

// Triangles of mesh.sheet whose rest angles flow where the bending moment exceeds a limit.
struct CreasedSheet {
  const TetMesh& mesh;
  int first;                       // triangle
  std::span<const double> moment;  // D of each triangle [N m]
  RestAngles rest;                 // at the start of the simulation
  double yield;                    // limit of the moment per length [N]
};

// Returns the bending of the sheet as a dissipation potential with internal variables, the elastic parts e of theta -
// theta0. With t = e at the start + the change of theta in the step and the largest elastic part s = yield l / k,
//   D = sum of k t^2 / 2 if |t| <= s, else k s (|t| - s / 2),  minus the energy sum of k e^2 / 2 at the start.
// The loss k s |change of theta0| is that of rest angles that follow theta.
std::unique_ptr<Energy> make_creases(std::string name, const CreasedSheet& sheet);

}  // namespace aspic
