// A hollow ellipsoid about the z axis, closed at its lower end and cut off above: the idealized chamber of a heart.
#pragma once
#include "mesh/tet_mesh.h"

namespace aspic {

struct Chamber {
  double inner_radius, inner_length;  // semi-axes of the cavity across and along z [m]
  double outer_radius, outer_length;  // semi-axes of the outer surface [m]
  double base;                        // z of the cut [m]; the center is at 0 and the tip at -outer_length

  // Returns the point at the share `depth` from the inner (0) to the outer surface, and `height` from the tip (0) to
  // the base (1).
  Vec3d point(double depth, double height, double angle) const;
};

struct ChamberCells {
  int rings;           // from the tip to the base
  int layers;          // through the wall
  int quarters = 4;    // of a turn: 1 to 4
  double grading = 1;  // exponent of the heights: above 1, cells at the tip are smaller
};

// Meshes the chamber with prisms of three tets. Ring j of a layer has j cells per quarter, so that doubled counts
// refine the same grid. Requires semi-axes of the outer surface above those of the cavity, and |base| < inner_length.
TetMesh make_chamber(const Chamber& chamber, const ChamberCells& cells);

// Returns the counts for cells of about the given size [m].
ChamberCells chamber_cells(const Chamber& chamber, double size);
double tets_in_chamber(const Chamber& chamber, double size);  // without meshing

}  // namespace aspic
