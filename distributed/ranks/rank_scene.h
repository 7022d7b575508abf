// The part of a scene that one rank simulates, as plain data.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "material/registry.h"
#include "mesh/box.h"
#include "ranks/mesh_share.h"

namespace aspic::distributed {

// Facts about a whole body for its selections.
struct BodyFacts {
  Box box;                                 // of the placed rest shape
  std::pair<double, double> heights = {};  // least and largest against gravity [m]; unused for generated boxes
  std::vector<Vec3d> corners = {};         // of a generated box: its extent along any direction; else empty
};

struct RankScene {
  MeshShare share;
  TetMesh mesh;  // the local vertices and tets
  std::vector<BodyFacts> bodies;
  // Computed by rank 0, or empty: each rank computes them from the document.
  std::vector<double> q, qdot;                 // at time 0, 3 per local vertex
  std::vector<double> density;                 // of each local tet
  std::vector<MaterialParameters> parameters;  // of each local tet
  std::vector<std::string> materials;          // of each body
};

}  // namespace aspic::distributed
