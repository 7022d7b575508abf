// VTK XML unstructured grids (.vtu) and their time index (.pvd), as ParaView and meshio read them.
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

struct Field {
  std::string name;
  int components = 1;  // 1, 3, 6 or 9 numbers per point or cell
  std::vector<double> values;
};

struct Vtu {
  TetMesh mesh;       // points are the positions written; region when the file has a "region" cell field
  TriMesh triangles;  // triangle cells, when there are no tets
  std::vector<Field> point_fields, cell_fields;
};

Vtu read_vtu(const std::filesystem::path& path);  // ascii, inline base64 and appended, raw or zlib-compressed
void write_vtu(const std::filesystem::path& path, std::span<const double> points, const std::vector<Tet>& tets,
               const std::vector<Field>& point_fields, const std::vector<Field>& cell_fields);

// A time series: (time [s], file name relative to the index).
void write_pvd(const std::filesystem::path& path, const std::vector<std::pair<double, std::string>>& frames);

}  // namespace aspic
