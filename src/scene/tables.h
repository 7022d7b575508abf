// Reads tables of numbers and values per element of a body: its tets, or the triangles of a sheet.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "mesh/tet_mesh.h"
#include "scene/painted_fields.h"
#include "scene/scene_files.h"
#include "scene/schema.h"
#include "scene/selection.h"
#include "scene/value.h"

namespace aspic {

// Reads `rows` lines of `columns` numbers, separated by commas, semicolons or blanks. A header line, empty lines and
// lines that begin with # are skipped. `row`: what a line represents ("a tet"). Throws InvalidInput with file and line.
std::vector<double> read_number_table(const std::filesystem::path& path, size_t columns, size_t rows,
                                      const std::string& row, const Place& place);

struct FieldScope {
  const TetMesh& mesh;  // of a placed body
  SceneFiles& files;
  std::string stem;  // name of files in the results
  PaintedFields& painted;
  const WholeBody* whole = nullptr;    // null: the mesh is the whole body
  const MeshGroups* groups = nullptr;  // of the mesh file; null: none
};

// Returns `table[key.name]` for each element: a number, a formula of the centroid, a number per region, or a file,
// checked against the range of the key. Files are added to the results.
std::vector<double> element_values(Table& table, const Key& key, const FieldScope& scope);

}  // namespace aspic
