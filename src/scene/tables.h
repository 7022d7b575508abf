// Reads tables of numbers and values per tet.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "mesh/tet_mesh.h"
#include "scene/scene_files.h"
#include "scene/schema.h"
#include "scene/value.h"

namespace aspic {

// Reads `rows` lines of `columns` numbers, separated by commas, semicolons or blanks. A header line, empty lines and
// lines that begin with # are skipped. `row`: what a line represents ("a tet"). Throws InvalidInput with file and line.
std::vector<double> read_number_table(const std::filesystem::path& path, size_t columns, size_t rows,
                                      const std::string& row, const Place& place);

// Returns `table[key.name]` for each tet of a placed body: a number, a formula of the centroid, a number per region, or
// a file, checked against the range of the key. Files are added to the results as `stem`.
std::vector<double> tet_values(Table& table, const Key& key, const TetMesh& mesh, SceneFiles& files,
                               const std::string& stem);

}  // namespace aspic
