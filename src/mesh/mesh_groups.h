// Named parts of a mesh file.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

// Triangles with a common label: a physical surface or an entity of Gmsh, or a reference of Medit.
struct SurfaceGroup {
  int label = 0;
  std::string name;  // empty: only a number
  std::vector<Triangle> triangles;
};

struct MeshGroups {
  std::vector<SurfaceGroup> surfaces;
  std::map<int, std::string> region_names;  // by region label
};

}  // namespace aspic
