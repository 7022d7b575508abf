// Shapes of bodies that one would animate, filled with tets once and kept in a folder.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic::bench {

struct Detail {
  std::string name;  // "3k": approximate number of vertices
  double edge;       // [units of the file] that gives them
};

struct Shape {
  std::string name, source;
  std::string file;  // in the folder; empty: generated, so that it is always there
  int up;            // the axis of the file that points up
  std::vector<Detail> details;
};
const std::vector<Shape>& shapes();
const Shape& shape_named(const std::string& name);  // throws InvalidInput with the names there are

bool is_available(const Shape& shape, const std::filesystem::path& folder);

// 1 m high, standing on y = 0, y up. Reads NAME_DETAIL.mesh of the folder, or makes and keeps it. Throws InvalidInput
// when the mesher is missing or fails.
TetMesh standing_mesh(const Shape& shape, const Detail& detail, const std::filesystem::path& folder);

}  // namespace aspic::bench
