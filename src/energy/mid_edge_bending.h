// Bending of thin sheets and shells that converges on any mesh. Each edge has an unknown angle xi between its normal
// and the mean of the normals of its two triangles. One triangle has the half angle a = theta / 2 + xi at the edge, the
// other one a = theta / 2 - xi:
//   V = sum over triangles of (a - a0)' Q (a - a0) / 2,  Q = A B' D B,  B_k = l_k / A (nx^2, ny^2, 2 nx ny)
// theta is the angle between both triangles (see hinge_angle.h). l, n and A are the lengths of the edges, their normals
// in the rest plane, and the area. D is the plate stiffness. Small deflections are those of Morley's plate element.
//   free border edge:                 a = xi
//   edge at a held triangle:          a = theta for its neighbor, and a = 0 for the held triangle; no xi
//   edge between two held triangles:  a = theta / 2 for both; no xi
//
// The unknowns are consecutive rows of the state, each of three edges in the order of edge_uses(). An entry is xi times
// the mean length of the edges. A soft spring holds unused entries at 0.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "energy/angle_row.h"
#include "energy/energy.h"
#include "energy/hinge_bending.h"
#include "energy/membrane.h"
#include "mesh/tet_mesh.h"

namespace aspic {

// Moments of a plate [N m] for curvatures (k11, k22, 2 k12): [D11 k11 + D12 k22, D12 k11 + D22 k22, D33 2 k12].
struct PlateStiffness {
  double D11, D22, D12, D33;
  PlaneVector axis = {1, 0};  // direction 1 in the rest plane of the triangle, a unit vector
};

// Returns t^3 / 12 times the plane-stress moduli of a sheet.
PlateStiffness plate_stiffness(const MembraneLaw& law);

struct MidEdgeSheet {
  std::span<const Vec3d> rest;  // X of all vertices [m]
  const std::vector<Triangle>& triangles;
  std::span<const PlateStiffness> stiffness;  // one per triangle
  RestAngles rest_angles = RestAngles::of_rest;
  int first_row = 0;  // of its angles
  // 1: a Dirichlet condition holds the vertex, also if it moves it; empty: none. Later changes have no effect.
  std::span<const char> held = {};
};

// Returns the rows of the angles of a sheet. Its edges have the rotary inertia density t^3 A / 12 of a third of their
// triangles; the entries of a row have the mean of their masses. `mass`: t^3 / 12 times the density of each triangle
// [kg].
std::vector<AngleRow> make_angle_rows(std::span<const Vec3d> rest, const std::vector<Triangle>& triangles,
                                      std::span<const double> mass);

class MidEdgeBending : public SteadyEnergy {
 public:
  // Writes the energy per area of each triangle at rest [J/m^2]; resizes the list.
  virtual void evaluate(Positions x, std::vector<double>& energy_density) const = 0;
};

// V is +inf where a triangle is collapsed. Requires positive areas at rest, positive definite stiffnesses, and at most
// two triangles per edge.
std::unique_ptr<MidEdgeBending> make_mid_edge_bending(const MidEdgeSheet& sheet);

}  // namespace aspic
