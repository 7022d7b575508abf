// Fills a closed surface with tets by running the separate program aspic-mesh.
#pragma once
#include <filesystem>

#include "mesh/tet_mesh.h"

namespace aspic {

struct TetrahedraliseOptions {
  double size = 0;     // target edge length in the units of the surface; 0: the diagonal of the bounding box / 25
  double seconds = 0;  // wall time after which filling fails; 0: the program's default
  std::filesystem::path program;  // aspic-mesh; empty: beside the running program, then on the PATH
};

// Throws InvalidInput with what the program said, or how to install it; TimeLimitPassed when time ran out.
TetMesh tetrahedralise(const std::filesystem::path& surface, const TetrahedraliseOptions& options);

}  // namespace aspic
