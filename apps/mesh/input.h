// What must hold before the mesher is asked.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

struct CheckedSurface {
  TriMesh mesh;
  std::vector<std::string> actions;  // what was mended without being asked: one sentence each
};

enum class Defects { refuse, fill_small_holes, rebuild };

// A closed surface that does not run into itself; duplicate vertices, as in every STL file, are merged.
// Throws InvalidInput naming triangles and remedy.
CheckedSurface checked_surface(const std::filesystem::path& path, Defects defects);

bool is_image(const std::filesystem::path& path);

// Throws InvalidInput when no format of that name holds tets: before the work rather than after it.
void check_output(const std::filesystem::path& path);

// "LABEL=SIZE"
std::pair<int, double> parsed_region_size(const std::string& text);

}  // namespace aspic
