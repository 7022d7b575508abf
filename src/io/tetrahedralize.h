// Fills a closed surface with tets by running the separate program aspic-mesh.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

struct TetrahedralizeOptions {
  double size = 0;     // target edge length in the units of the surface; 0: the diagonal of the bounding box / 25
  double seconds = 0;  // wall time after which filling fails; 0: the program's default
  std::filesystem::path program;  // aspic-mesh; empty: beside the running program, then on the PATH
};

struct Tetrahedralization {
  TetMesh tets;
  std::vector<std::string> notes;  // of the program: what it mended, where edges are short; one sentence each
};

// Throws InvalidInput with the message of the program, or how to install it; TimeLimitPassed when time ran out.
Tetrahedralization tetrahedralize(const std::filesystem::path& surface, const TetrahedralizeOptions& options);

}  // namespace aspic
