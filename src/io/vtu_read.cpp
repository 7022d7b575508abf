#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/vtu.h"
#include "io/vtu_array.h"

namespace aspic {
namespace {

// Cell types of VTK [vtkCellType.h]; types 2 and 3 are several vertices and a line.
constexpr int kVertex = 1, kPolyLine = 4, kTriangle = 5, kQuad = 9, kTet = 10, kQuadraticTet = 24;

bool is_tet(int64_t type) { return type == kTet || type == kQuadraticTet; }

constexpr int64_t kMaxCount = std::numeric_limits<int>::max() / 4;

// One <Piece>: points, cells and their fields.
struct Piece {
  const XmlElement* element = nullptr;
  size_t points = 0, cells = 0;
  std::vector<double> positions;
  std::vector<int64_t> connectivity, offsets, types;
};

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

void check_cell_shape(const VtkFile& file, const XmlElement& at, int64_t type, int64_t corners, size_t cell) {
  const auto expected = type == kTet ? 4 : type == kTriangle ? 3 : type == kQuad ? 4 : type == kQuadraticTet ? 10 : -1;
  const bool passed_over = type >= kVertex && type <= kPolyLine;
  if (expected < 0 && !passed_over) {
    fail_at(file, at,
            "cell " + std::to_string(cell) + " has type " + std::to_string(type) +
                "; only tets (10), quadratic tets (24), triangles (5) and quads (9) can be read (in ParaView: "
                "Tetrahedralize)");
  }
  if (expected >= 0 && corners != expected) {
    fail_at(file, at,
            "cell " + std::to_string(cell) + " of type " + std::to_string(type) + " has " + std::to_string(corners) +
                " corners");
  }
}

void check_cells(const VtkFile& file, const XmlElement& at, const Piece& piece) {
  int64_t previous = 0;
  for (size_t cell = 0; cell < piece.cells; ++cell) {
    check_cell_shape(file, at, piece.types[cell], piece.offsets[cell] - previous, cell);
    previous = piece.offsets[cell];
  }
  for (size_t i = 0; i < piece.connectivity.size(); ++i) {
    const int64_t vertex = piece.connectivity[i];
    if (vertex < 0 || vertex >= static_cast<int64_t>(piece.points)) {
      fail_at(file, at, "a cell names point " + std::to_string(vertex) + " of " + std::to_string(piece.points));
    }
  }
}

void read_cells(const VtkFile& file, Piece& piece) {
  const XmlElement& cells = section(file, *piece.element, "Cells");
  piece.offsets = read_integers(file, named_array(file, cells, "offsets"), piece.cells);
  piece.types = read_integers(file, named_array(file, cells, "types"), piece.cells);
  int64_t previous = 0;
  for (const int64_t offset : piece.offsets) {
    if (offset < previous) fail_at(file, cells, "the offsets of the cells do not ascend");
    previous = offset;
  }
  piece.connectivity = read_integers(file, named_array(file, cells, "connectivity"), static_cast<size_t>(previous));
  check_cells(file, cells, piece);
}

std::vector<double> read_points(const VtkFile& file, const XmlElement& piece, size_t count) {
  if (count == 0) return {};
  const XmlElement& array = section(file, section(file, piece, "Points"), "DataArray");
  if (count_attribute(file, array, "NumberOfComponents", 1, 1024) != 3)
    fail_at(file, array, "points need 3 components");
  std::vector<double> positions = read_reals(file, array, 3 * count);
  const auto wrong = std::find_if(positions.begin(), positions.end(), [](double x) { return !std::isfinite(x); });
  if (wrong != positions.end())
    fail_at(file, array, "point " + std::to_string((wrong - positions.begin()) / 3) + " is not finite");
  return positions;
}

size_t point_count(const VtkFile& file, const XmlElement& piece) {
  return static_cast<size_t>(count_attribute(file, piece, "NumberOfPoints", 0, kMaxCount));
}

Piece read_piece(const VtkFile& file, const XmlElement& element) {
  Piece piece;
  piece.element = &element;
  piece.points = point_count(file, element);
  piece.cells = static_cast<size_t>(count_attribute(file, element, "NumberOfCells", 0, kMaxCount));
  piece.positions = read_points(file, element, piece.points);
  if (piece.cells > 0) read_cells(file, piece);
  return piece;
}

// Kept cells: their corners, and the index of the original cell.
struct Kept {
  std::vector<Tet> tets;
  std::vector<MidNodes> mids;  // one per tet
  std::vector<Triangle> triangles;
  std::vector<size_t> tet_source, triangle_source;
};

Kept kept_cells(const Piece& piece, int first_point) {
  Kept kept;
  for (size_t cell = 0; cell < piece.cells; ++cell) {
    const size_t start = cell == 0 ? 0 : static_cast<size_t>(piece.offsets[cell - 1]);
    const auto corner = [&](size_t i) { return first_point + static_cast<int>(piece.connectivity[start + i]); };
    if (is_tet(piece.types[cell])) {
      kept.tets.push_back({corner(0), corner(1), corner(2), corner(3)});
      kept.tet_source.push_back(cell);
      MidNodes& mids = kept.mids.emplace_back(MidNodes{-1, -1, -1, -1, -1, -1});
      for (size_t k = 0; k < 6 && piece.types[cell] == kQuadraticTet; ++k) mids[k] = corner(4 + k);
    } else if (piece.types[cell] == kTriangle || piece.types[cell] == kQuad) {
      kept.triangles.push_back({corner(0), corner(1), corner(2)});
      kept.triangle_source.push_back(cell);
      if (piece.types[cell] == kTriangle) continue;
      kept.triangles.push_back({corner(0), corner(2), corner(3)});
      kept.triangle_source.push_back(cell);
    }
  }
  return kept;
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

Field gathered(const Field& field, const std::vector<size_t>& source) {
  const auto width = static_cast<size_t>(field.components);
  Field result{field.name, field.components, {}, field.type};
  result.values.reserve(source.size() * width);
  for (const size_t cell : source) {
    const auto first = field.values.begin() + static_cast<std::ptrdiff_t>(cell * width);
    result.values.insert(result.values.end(), first, first + field.components);
  }
  return result;
}

void append_fields(const VtkFile& file, const XmlElement& at, bool first, std::vector<Field> added,
                   std::vector<Field>& all) {
  if (first) {
    all = std::move(added);
    return;
  }
  bool alike = added.size() == all.size();
  for (size_t i = 0; alike && i < all.size(); ++i) {
    alike = all[i].name == added[i].name && all[i].components == added[i].components;
    if (alike) all[i].values.insert(all[i].values.end(), added[i].values.begin(), added[i].values.end());
  }
  if (!alike) fail_at(file, at, "the pieces have different fields");
}

std::vector<int> region_of(const std::string& file, const std::vector<Field>& cell_fields) {
  const auto field =
      std::find_if(cell_fields.begin(), cell_fields.end(), [](const Field& f) { return f.name == "region"; });
  if (field == cell_fields.end() || field->components != 1) return {};
  std::vector<int> region;
  for (const double value : field->values) {
    if (!(std::abs(value) <= std::numeric_limits<int>::max()) || value != std::floor(value)) {
      throw InvalidInput(file + ": cell field 'region' holds " + std::to_string(value) +
                         ", which is no whole number (rename the field if it is no label)");
    }
    region.push_back(static_cast<int>(value));
  }
  return region;
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

Vtu parse_vtu(std::string_view contents, const std::string& name) {
  const XmlElement root = parse_xml(contents, name, "AppendedData");
  const VtkFile file = vtk_file(root, "UnstructuredGrid", name);
  const XmlElement& grid = section(file, root, "UnstructuredGrid");

  std::vector<Piece> pieces;
  size_t points = 0;
  bool has_tets = false;
  for (const XmlElement& element : grid.children) {
    if (element.name != "Piece") continue;
    pieces.push_back(read_piece(file, element));
    points += pieces.back().points;
    if (points > static_cast<size_t>(kMaxCount)) fail_at(file, element, "too many points");
    has_tets |= std::any_of(pieces.back().types.begin(), pieces.back().types.end(), is_tet);
  }

  Vtu vtu;
  vtu.file_fields = read_file_fields(file, grid);
  std::vector<Vec3d>& vertices = has_tets ? vtu.mesh.rest : vtu.triangles.vertices;
  for (const Piece& piece : pieces) {
    const Kept kept = kept_cells(piece, static_cast<int>(vertices.size()));
    const bool first = &piece == pieces.data();
    for (size_t i = 0; i < piece.points; ++i) {
      vertices.push_back({{piece.positions[3 * i], piece.positions[3 * i + 1], piece.positions[3 * i + 2]}});
    }
    append_fields(file, *piece.element, first, read_fields(file, piece.element->child("PointData"), piece.points),
                  vtu.point_fields);
    std::vector<Field> cell_fields = read_fields(file, piece.element->child("CellData"), piece.cells);
    for (Field& field : cell_fields) field = gathered(field, has_tets ? kept.tet_source : kept.triangle_source);
    append_fields(file, *piece.element, first, std::move(cell_fields), vtu.cell_fields);
    if (has_tets) {
      vtu.mesh.tets.insert(vtu.mesh.tets.end(), kept.tets.begin(), kept.tets.end());
      vtu.mesh.mids.insert(vtu.mesh.mids.end(), kept.mids.begin(), kept.mids.end());
    } else {
      vtu.triangles.triangles.insert(vtu.triangles.triangles.end(), kept.triangles.begin(), kept.triangles.end());
    }
  }
  if (has_tets) vtu.mesh.region = region_of(file.name, vtu.cell_fields);
  std::vector<MidNodes>& mids = vtu.mesh.mids;
  if (std::all_of(mids.begin(), mids.end(), [](const MidNodes& m) { return m[0] < 0; })) mids.clear();
  return vtu;
}

}  // namespace aspic
