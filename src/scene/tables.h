// Numbers from files and values per tet.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "mesh/tet_mesh.h"
#include "scene/scene_files.h"
#include "scene/schema.h"
#include "scene/value.h"

namespace aspic {

// `rows` lines of `columns` numbers apart by commas, semicolons or blanks; one header line, empty lines and lines that
// begin with # are skipped. `row` says what a line stands for ("a tet"). Throws InvalidInput with file and line.
std::vector<double> read_number_table(const std::filesystem::path& path, size_t columns, size_t rows,
                                      const std::string& row, const Place& place);

// The value of `table[key.name]` in each tet of a placed body: a number, a formula of the centroid, a number per
// region, or a file. Each is checked against the key's range. Files are remembered under `stem`.
std::vector<double> tet_values(Table& table, const Key& key, const TetMesh& mesh, SceneFiles& files,
                               const std::string& stem);

}  // namespace aspic
