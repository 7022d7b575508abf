// Legacy VTK files (.vtk), text and binary, versions 1 to 5.1 [VTK file formats]: unstructured grids and polygonal
// data.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "io/vtu.h"

namespace aspic {

// Keeps and skips the same cells and fields as parse_vtu(). Throws InvalidInput with file and line or byte.
Vtu parse_legacy_vtk(std::string_view contents, const std::string& file);
// Returns whether the extension is .vtk or .vtu, in any case of letters.
bool is_vtk_or_vtu(const std::filesystem::path& path);
// Reads a .vtk or a .vtu.
Vtu read_vtk_or_vtu(const std::string& path);

}  // namespace aspic
