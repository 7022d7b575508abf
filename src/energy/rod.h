// Bending and twist of thin elastic rods: discrete elastic rods [Bergou 2010]. Each segment has a material frame: its
// tangent t and a director d1, with d2 = t x d1. A joint is a vertex of two segments, l before it and r after it:
//   V = sum over joints of b/4 (|k_l - k0|^2 + |k_r - k0|^2) + c/2 (twist - twist0)^2
// k_l and k_r are the components of the curvature binormal 2 t_l x t_r / (1 + t_l . t_r) along d1 and d2 of each
// segment, k0 those at rest. 1/b and 1/c are the sums of the compliances l/(2 E I) and l/(2 G J) of both segments. A
// held segment, between two pinned vertices, is rigid. The twist is the angle from d1 of l, transported to t_r, to d1
// of r.
//
// In a step, the director of a segment is transported from its tangent s at the start to t, the smallest rotation, and
// turned by the change of its angle. So V is a function of the positions and angles, whose gradient has the term -(s x
// t)/(1 + s . t) . dt for the spin of each director. Directors, curvatures and twists at the start are internal
// variables. V is +inf where a tangent turns by more than 134 degrees in a step.
//
// An entry of a row of angles is the angle times RodSegment::length. A soft spring holds unused entries at 0.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "energy/angle_row.h"
#include "energy/energy.h"
#include "energy/tet_elasticity.h"
#include "mesh/tet_mesh.h"

namespace aspic {

struct RodSegment {
  Segment ends;              // the first one is the last one of the segment before it
  double bending, torsion;   // E I and G J [N m^2]
  double natural_twist = 0;  // twist0 per length [rad/m]
  bool is_straight = false;  // rest curvature 0 instead of that of the mesh
  bool is_held = false;      // rigid
  int row = 0, entry = 0;    // of its angle in the state
  double length = 1;         // [m]
};

// Returns the term of all segments of mesh.rods, in their order. Requires positive lengths at rest, and at most two
// segments at a vertex, of which one ends there. It is a dissipation potential that stores all of its work, because
// its internal variables are part of the state: eight for each segment.
std::unique_ptr<Energy> make_rod_bending(const TetMesh& mesh, std::span<const RodSegment> segments);

// Returns the rows of the angles of `count` segments from mesh.rods[first], in their order. The entries of a row have
// the mean of the polar inertias of their segments over the square of `length`. `density`: of each of the segments
// [kg/m^3].
std::vector<AngleRow> make_rod_rows(const TetMesh& mesh, int first, std::span<const double> density, double length);

// Returns the stretching energy sum of E pi r^2 l0 (l / l0 - 1)^2 / 2 of segments [first, first + young.size()) of
// mesh.rods. Its fields are those of the stretch.
std::unique_ptr<TetElasticity> make_rod_stretch(const TetMesh& mesh, int first, std::span<const double> young);

}  // namespace aspic
