// Checks of the input before meshing.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

struct CheckedSurface {
  TriMesh mesh;
  std::vector<std::string> actions;  // automatic repairs, one sentence each
};

enum class Defects { refuse, fill_small_holes, rebuild };

// Reads a closed surface without self-intersections. Merges duplicate vertices, which every STL file has. Throws
// InvalidInput with triangles and remedy.
CheckedSurface checked_surface(const std::filesystem::path& path, Defects defects);

bool is_image(const std::filesystem::path& path);

// Throws InvalidInput if the extension has no format for tets, before any work is done.
void check_output(const std::filesystem::path& path);

// Parses "LABEL=SIZE".
std::pair<int, double> parsed_region_size(const std::string& text);

}  // namespace aspic
