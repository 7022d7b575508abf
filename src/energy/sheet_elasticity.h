// Elastic energy of a sheet: its membrane and its bending.
#pragma once
#include <memory>
#include <vector>

#include "energy/hinge_bending.h"
#include "energy/membrane.h"
#include "energy/mid_edge_bending.h"
#include "energy/tet_elasticity.h"

namespace aspic {

struct SheetMaterial {
  std::vector<MembraneLaw> laws;  // one per triangle
  std::vector<double> moment;     // bending stiffness of each triangle [N m]
  RestAngles rest = RestAngles::of_rest;
  bool bends = true;  // false: bending is another term, see make_creases()
  // Mid-edge bending, see MidEdgeSheet. Empty: hinges.
  std::vector<PlateStiffness> plates = {};  // one per triangle
  int first_angle_row = 0;
  std::vector<char> held = {};
};

// Returns the energy of triangles [first, first + count) of mesh.sheet for a material of `count` triangles. In its
// fields, det F is the ratio of areas; the energy density and the stress are means over the thickness, without bending.
std::unique_ptr<TetElasticity> make_sheet_elasticity(const TetMesh& mesh, int first, const SheetMaterial& material);

}  // namespace aspic
