#include <limits>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/vtk_cells.h"
#include "io/vtu.h"
#include "io/vtu_array.h"

namespace aspic {
namespace {

constexpr int64_t kMaxCount = std::numeric_limits<int>::max() / 4;

const XmlElement& section(const VtkFile& file, const XmlElement& parent, std::string_view name) {
  const XmlElement* found = parent.child(name);
  if (!found) fail_at(file, parent, "<" + parent.name + "> has no <" + std::string(name) + ">");
  return *found;
}

const XmlElement& named_array(const VtkFile& file, const XmlElement& parent, std::string_view name) {
  for (const XmlElement& array : parent.children) {
    if (const std::string* its = array.attribute("Name"); array.name == "DataArray" && its && *its == name)
      return array;
  }
  fail_at(file, parent, "<" + parent.name + "> has no array '" + std::string(name) + "'");
}

void read_cells(const VtkFile& file, const XmlElement& element, size_t count, VtkPiece& piece) {
  const XmlElement& cells = section(file, element, "Cells");
  piece.offsets = read_integers(file, named_array(file, cells, "offsets"), count);
  piece.types = read_integers(file, named_array(file, cells, "types"), count);
  int64_t previous = 0;
  for (const int64_t offset : piece.offsets) {
    if (offset < previous) fail_at(file, cells, "the offsets of the cells do not ascend");
    previous = offset;
  }
  piece.connectivity = read_integers(file, named_array(file, cells, "connectivity"), static_cast<size_t>(previous));
  if (const std::string fault = fault_of_cells(piece); !fault.empty()) fail_at(file, cells, fault);
}

std::vector<double> read_points(const VtkFile& file, const XmlElement& piece, size_t count) {
  if (count == 0) return {};
  const XmlElement& array = section(file, section(file, piece, "Points"), "DataArray");
  if (count_attribute(file, array, "NumberOfComponents", 1, 1024) != 3)
    fail_at(file, array, "points need 3 components");
  std::vector<double> positions = read_reals(file, array, 3 * count);
  if (const std::string fault = fault_of_positions(positions); !fault.empty()) fail_at(file, array, fault);
  return positions;
}

size_t point_count(const VtkFile& file, const XmlElement& piece) {
  return static_cast<size_t>(count_attribute(file, piece, "NumberOfPoints", 0, kMaxCount));
}

FieldType field_type(const XmlElement& array) {
  const std::string* type = array.attribute("type");
  if (!type || *type == "Float64" || *type == "Int64" || *type == "UInt64" || *type == "UInt32")
    return FieldType::float64;
  return *type == "Float32" ? FieldType::float32 : FieldType::int32;
}

bool is_text(const XmlElement& array) {
  const std::string* type = array.attribute("type");
  return type && *type == "String";
}

Field read_field(const VtkFile& file, const XmlElement& array, size_t count) {
  const auto components = static_cast<size_t>(count_attribute(file, array, "NumberOfComponents", 1, 1024));
  const std::string* name = array.attribute("Name");
  if (components == 0) fail_at(file, array, "NumberOfComponents is 0");
  return {name ? *name : "", static_cast<int>(components), read_reals(file, array, components * count),
          field_type(array)};
}

// Reads the arrays of <PointData> or <CellData>; skips text.
std::vector<Field> read_fields(const VtkFile& file, const XmlElement* section, size_t count) {
  std::vector<Field> fields;
  if (!section) return fields;
  for (const XmlElement& array : section->children)
    if (array.name == "DataArray" && !is_text(array)) fields.push_back(read_field(file, array, count));
  return fields;
}

// Reads the arrays of <FieldData>, which have different lengths.
std::vector<Field> read_file_fields(const VtkFile& file, const XmlElement& grid) {
  std::vector<Field> fields;
  const XmlElement* section = grid.child("FieldData");
  if (!section) return fields;
  for (const XmlElement& array : section->children) {
    if (array.name != "DataArray" || is_text(array) || !array.attribute("NumberOfTuples")) continue;
    const auto tuples = static_cast<size_t>(count_attribute(file, array, "NumberOfTuples", 0, kMaxCount));
    fields.push_back(read_field(file, array, tuples));
  }
  return fields;
}

VtkPiece read_piece(const VtkFile& file, const XmlElement& element) {
  VtkPiece piece;
  const size_t points = point_count(file, element);
  const auto cells = static_cast<size_t>(count_attribute(file, element, "NumberOfCells", 0, kMaxCount));
  piece.positions = read_points(file, element, points);
  if (cells > 0) read_cells(file, element, cells, piece);
  piece.point_fields = read_fields(file, element.child("PointData"), points);
  piece.cell_fields = read_fields(file, element.child("CellData"), cells);
  return piece;
}

}  // namespace

Vtu read_vtu(const std::string& path) { return parse_vtu(read_file(path), path); }

std::vector<double> read_vtu_points(const std::string& path) {
  const std::string contents = read_file(path);
  const XmlElement root = parse_xml(contents, path, "AppendedData");
  const VtkFile file = vtk_file(root, "UnstructuredGrid", path);
  std::vector<double> points;
  for (const XmlElement& piece : section(file, root, "UnstructuredGrid").children) {
    if (piece.name != "Piece") continue;
    const std::vector<double> more = read_points(file, piece, point_count(file, piece));
    points.insert(points.end(), more.begin(), more.end());
  }
  return points;
}

std::vector<double> read_vtu_cell_field(const std::string& path, std::string_view name) {
  const std::string contents = read_file(path);
  const XmlElement root = parse_xml(contents, path, "AppendedData");
  const VtkFile file = vtk_file(root, "UnstructuredGrid", path);
  std::vector<double> values;
  for (const XmlElement& piece : section(file, root, "UnstructuredGrid").children) {
    const XmlElement* fields = piece.name == "Piece" ? piece.child("CellData") : nullptr;
    if (!fields) continue;
    const auto cells = static_cast<size_t>(count_attribute(file, piece, "NumberOfCells", 0, kMaxCount));
    for (const XmlElement& array : fields->children) {
      const std::string* own = array.attribute("Name");
      if (array.name != "DataArray" || is_text(array) || !own || *own != name) continue;
      const Field field = read_field(file, array, cells);
      values.insert(values.end(), field.values.begin(), field.values.end());
    }
  }
  return values;
}

Vtu parse_vtu(std::string_view contents, const std::string& name) {
  const XmlElement root = parse_xml(contents, name, "AppendedData");
  const VtkFile file = vtk_file(root, "UnstructuredGrid", name);
  const XmlElement& grid = section(file, root, "UnstructuredGrid");

  std::vector<std::pair<const XmlElement*, VtkPiece>> pieces;
  size_t points = 0;
  bool has_tets = false;
  for (const XmlElement& element : grid.children) {
    if (element.name != "Piece") continue;
    const VtkPiece& piece = pieces.emplace_back(&element, read_piece(file, element)).second;
    points += piece.points();
    if (points > static_cast<size_t>(kMaxCount)) fail_at(file, element, "too many points");
    has_tets |= piece.has_tets();
  }

  Vtu vtu;
  vtu.file_fields = read_file_fields(file, grid);
  for (auto& entry : pieces)
    if (!append_piece(std::move(entry.second), has_tets, &entry == pieces.data(), vtu))
      fail_at(file, *entry.first, "the pieces have different fields");
  if (const std::string fault = finish_grid(vtu); !fault.empty()) throw InvalidInput(file.name + ": " + fault);
  return vtu;
}

}  // namespace aspic
