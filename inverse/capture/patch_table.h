// The table of triangles of a patch.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "capture/measured_table.h"
#include "capture/surface_projection.h"
#include "scene/value.h"

namespace aspic {

// Those listed in the file that is called `name` in the settings, in the numbers of `boundary` and oriented as there;
// the first corner may be any.
std::vector<Triangle> listed_triangles(const std::filesystem::path& file, const Value& name,
                                       const std::vector<Triangle>& boundary, ErrorList& errors,
                                       std::vector<std::string>& notes);

}  // namespace aspic
