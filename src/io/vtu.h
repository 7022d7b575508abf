// VTK XML unstructured grids (.vtu) and their time index (.pvd), as read by ParaView and meshio.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

// Type of the stored numbers.
enum class FieldType { float64, float32, int32 };

// Values at points or cells, all components of one after those of the other.
struct Field {
  std::string name;
  int components = 1;          // 1, 3, 6 or 9 values per point or cell
  std::vector<double> values;  // `components` times the number of points or cells
  FieldType type = FieldType::float64;
};

// Fields of a file: one value set per point, per cell, or for the whole file.
struct VtuFields {
  std::vector<Field> point_fields = {}, cell_fields = {};
  std::vector<Field> file_fields = {};  // <FieldData> of any length; text is skipped
};

struct Vtu : VtuFields {
  TetMesh mesh;                        // points are the vertices; region is set if the file has a cell field "region"
  TriMesh triangles;                   // triangle cells if there are no tets
  std::vector<Segment> segments = {};  // line cells between vertices of `triangles` if there are no tets
};

// Reads ascii, inline base64 and appended data, raw or zlib-compressed. Splits quads and skips lines and points. Throws
// InvalidInput with file and line for other cells, and for inconsistent counts, indices or sizes.
Vtu read_vtu(const std::string& path);
Vtu parse_vtu(std::string_view contents, const std::string& file);  // `file` is the name in messages
// Reads only the points, 3 coordinates each [m]. Throws InvalidInput like read_vtu().
std::vector<double> read_vtu_points(const std::string& path);
// Reads only the field of all cells with this name, in the order of the file; empty if it has none. Throws InvalidInput
// like read_vtu().
std::vector<double> read_vtu_cell_field(const std::string& path, std::string_view name);
// Reads the pieces of a .pvtu and returns the whole grid of tets, in the order of the fields "vertex" and "tet", which
// it removes. Throws InvalidInput if they are missing, or if vertices or tets are.
Vtu read_pvtu(const std::string& path);
// Returns the grid of a frame of a run, a .vtu or .pvtu.
Vtu read_frame(const std::string& path);

// Writes the elements of a mesh in inline base64, zlib-compressed. `points`: 3 coordinates per point [m], in double
// precision. Point fields have one entry of `components` values per point, cell fields one per element. The output is
// reproducible. Throws InvalidInput if the file cannot be written.
void write_vtu(const std::string& path, std::span<const double> points, const TetMesh& mesh,
               const VtuFields& fields = {});
void write_vtu(const std::string& path, std::span<const double> points, const std::vector<Tet>& tets,
               const VtuFields& fields = {});

// Writes a surface in the same way; cell fields have one entry per triangle.
void write_surface_vtu(const std::string& path, const TriMesh& surface, const VtuFields& fields = {});

// Writes the index of a grid in pieces (.pvtu): `pieces` are file names relative to it, with the given fields; values
// of `fields` are ignored, except those of the file fields. Throws InvalidInput if the file cannot be written.
void write_pvtu(const std::string& path, const std::vector<std::string>& pieces, const VtuFields& fields);

// Writes the index of a time series: (time [s], file name relative to the index). `others`: empty, or a second file
// name for each frame. Throws InvalidInput if the file cannot be written.
void write_pvd(const std::string& path, const std::vector<std::pair<double, std::string>>& frames,
               const std::vector<std::string>& others = {});

}  // namespace aspic
