// A row of the state whose entries are angles at three edges of a sheet, see mid_edge_bending.h.
#pragma once
#include "math/small.h"

namespace aspic {

struct AngleRow {
  Vec3d center;  // mean of the midpoints of its edges at rest [m]
  double mass;   // of each entry [kg]
  int vertex;    // an end of its first edge
};

}  // namespace aspic
