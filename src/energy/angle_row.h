// A row of the state whose entries are angles at three edges of a sheet or of three segments of a rod, see
// mid_edge_bending.h and rod.h.
#pragma once
#include "math/small.h"

namespace aspic {

struct AngleRow {
  Vec3d center;  // mean of the midpoints of its edges or segments at rest [m]
  double mass;   // of each entry [kg]
  int vertex;    // an end of its first edge or segment
};

}  // namespace aspic
