// VTK XML unstructured grids (.vtu) and their time index (.pvd), as ParaView and meshio read them.
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

// How a field is stored: single precision halves what is only looked at.
enum class FieldType { float64, float32, int32 };

struct Field {
  std::string name;
  int components = 1;  // 1, 3, 6 or 9 numbers per point or cell
  std::vector<double> values;
  FieldType type = FieldType::float64;
};

struct Vtu {
  TetMesh mesh;       // points are the positions written; region when the file has a "region" cell field
  TriMesh triangles;  // triangle cells, when there are no tets
  std::vector<Field> point_fields, cell_fields;
  std::vector<Field> file_fields;  // <FieldData>: numbers of the whole file, of any length; text is passed over
};

// Ascii, inline base64 and appended, raw or zlib-compressed. Quads are split; lines and points are passed over; any
// other cell is an error, as are counts, indices and sizes that do not fit. Throws InvalidInput with file and line.
Vtu read_vtu(const std::filesystem::path& path);
Vtu parse_vtu(std::string_view contents, const std::string& file);  // `file` is for messages
// The points alone, 3 numbers each: much less work where the cells are known.
std::vector<double> read_vtu_points(const std::filesystem::path& path);

// Inline base64, zlib-compressed; positions in double precision. The same input gives the same bytes.
void write_vtu(const std::filesystem::path& path, std::span<const double> points, const std::vector<Tet>& tets,
               const std::vector<Field>& point_fields, const std::vector<Field>& cell_fields,
               const std::vector<Field>& file_fields = {});

// A time series: (time [s], file name relative to the index).
void write_pvd(const std::filesystem::path& path, const std::vector<std::pair<double, std::string>>& frames);

}  // namespace aspic
