// TetGen's pair of text files: .node (vertices) and .ele (tets). A tet's first attribute is its region.
#pragma once
#include <string>
#include <string_view>

#include "io/mesh_content.h"

namespace aspic {

struct TetgenText {
  std::string node, ele;
};

// Vertices are numbered from 0 or 1, as the first line shows.
MeshContent parse_tetgen(const std::string& node_file, std::string_view node, const std::string& ele_file,
                         std::string_view ele);
TetgenText tetgen_text(const TetMesh& mesh);

}  // namespace aspic
