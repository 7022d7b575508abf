// Table of the triangles of a patch.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "data/measured_table.h"
#include "data/surface_projection.h"
#include "scene/value.h"

namespace aspic {

// Reads the triangles of the file with key `name` in the settings, in the numbering and orientation of `boundary`; any
// corner can be first.
std::vector<Triangle> listed_triangles(const std::filesystem::path& file, const Value& name,
                                       const std::vector<Triangle>& boundary, ErrorList& errors,
                                       std::vector<std::string>& notes);

}  // namespace aspic
