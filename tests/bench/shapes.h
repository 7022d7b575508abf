// Realistic body shapes, filled with tets once and stored in a folder.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic::bench {

struct Detail {
  std::string name;  // "3k": approximate number of vertices
  double edge;       // edge length that gives them [units of the file]
};

struct Shape {
  std::string name, source;
  std::string file;  // file in the folder; empty: generated, so always available
  int up;            // axis of the file that points up
  std::vector<Detail> details;
};
const std::vector<Shape>& shapes();
const Shape& shape_named(const std::string& name);  // throws InvalidInput with the list of names

bool is_available(const Shape& shape, const std::filesystem::path& folder);

// Mesh of 1 m height, standing on y = 0, y up. Reads NAME_DETAIL.mesh from the folder, or creates and stores it. Throws
// InvalidInput if the mesher is missing or fails.
TetMesh standing_mesh(const Shape& shape, const Detail& detail, const std::filesystem::path& folder);

}  // namespace aspic::bench
