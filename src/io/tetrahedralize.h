// Fills a closed surface with tets by running the separate program aspic-mesh.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

struct TetrahedralizeOptions {
  double size = 0;                // target edge length in units of the surface; 0: diagonal of the bounding box / 25
  double seconds = 0;             // limit of wall time [s]; 0: default of the program
  std::filesystem::path program;  // aspic-mesh; empty: search beside the running program, then on the PATH
};

struct Tetrahedralization {
  TetMesh tets;
  std::vector<std::string> notes;  // repairs and short edges reported by the program; one sentence each
};

// Throws InvalidInput with the program's message, or with instructions to install it; TimeLimitPassed on a time-out.
Tetrahedralization tetrahedralize(const std::filesystem::path& surface, const TetrahedralizeOptions& options);

}  // namespace aspic
