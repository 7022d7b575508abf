#include "io/vtk_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/mesh_content.h"

namespace aspic {
namespace {

bool is_tet(int64_t type) { return type == kVtkTet || type == kVtkQuadraticTet; }
bool is_polygon(int64_t type) { return type == kVtkTriangle || type == kVtkPolygon || type == kVtkQuad; }
bool is_skipped(int64_t type) {
  return (type >= kVtkVertex && type <= kVtkPolyLine) || (type >= kVtkQuadraticEdge && type <= kVtkQuadraticQuad);
}

// Number of corners of a type; 0: any number from three.
int64_t corners_of(int64_t type) {
  if (type == kVtkTriangle) return 3;
  if (type == kVtkQuad || type == kVtkTet) return 4;
  return type == kVtkQuadraticTet ? 10 : 0;
}

std::string fault_of_cell(int64_t type, int64_t corners, size_t cell) {
  const std::string which = "cell " + std::to_string(cell) + " ";
  if (is_skipped(type)) return "";
  if (!is_tet(type) && !is_polygon(type) && type != kVtkStrip)
    return which + "has type " + std::to_string(type) +
           "; only tets (10), quadratic tets (24), triangles (5), quads (9) and polygons (7) can be read (in ParaView: "
           "Tetrahedralize)";
  const int64_t expected = corners_of(type);
  if (expected > 0 ? corners != expected : corners < 3)
    return which + "of type " + std::to_string(type) + " has " + std::to_string(corners) +
           " corners; get a complete copy";
  return "";
}

// Kept cells: their corners, and the index of the original cell.
struct Kept {
  std::vector<Tet> tets;
  std::vector<MidNodes> mids;  // one per tet
  std::vector<Triangle> triangles;
  std::vector<size_t> source;  // cell of each tet, or of each triangle
};

void add_strip(const std::vector<int>& corners, std::vector<Triangle>& triangles) {
  for (size_t i = 2; i < corners.size(); ++i) {
    const bool is_odd = i % 2 == 1;
    triangles.push_back({corners[i - (is_odd ? 1 : 2)], corners[i - (is_odd ? 2 : 1)], corners[i]});
  }
}

Kept kept_cells(const VtkPiece& piece, int first_point, bool keeps_tets) {
  Kept kept;
  std::vector<int> corners;
  for (size_t cell = 0; cell < piece.types.size(); ++cell) {
    const int64_t type = piece.types[cell];
    if (is_skipped(type) || is_tet(type) != keeps_tets) continue;
    corners.clear();
    for (int64_t i = cell == 0 ? 0 : piece.offsets[cell - 1]; i < piece.offsets[cell]; ++i)
      corners.push_back(first_point + static_cast<int>(piece.connectivity[static_cast<size_t>(i)]));
    if (keeps_tets) {
      kept.tets.push_back({corners[0], corners[1], corners[2], corners[3]});
      MidNodes& mids = kept.mids.emplace_back(MidNodes{-1, -1, -1, -1, -1, -1});
      if (type == kVtkQuadraticTet) std::copy(corners.begin() + 4, corners.end(), mids.begin());
    } else if (type == kVtkStrip) {
      add_strip(corners, kept.triangles);
    } else {
      add_fan(corners, kept.triangles);
    }
    kept.source.resize(kept.tets.size() + kept.triangles.size(), cell);
  }
  return kept;
}

void append_lines(const VtkPiece& piece, int first_point, std::vector<Segment>& segments) {
  for (size_t cell = 0; cell < piece.types.size(); ++cell) {
    if (piece.types[cell] != kVtkLine && piece.types[cell] != kVtkPolyLine) continue;
    for (int64_t i = cell == 0 ? 1 : piece.offsets[cell - 1] + 1; i < piece.offsets[cell]; ++i)
      segments.push_back({first_point + static_cast<int>(piece.connectivity[static_cast<size_t>(i - 1)]),
                          first_point + static_cast<int>(piece.connectivity[static_cast<size_t>(i)])});
  }
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

bool append_fields(bool is_first, std::vector<Field> added, std::vector<Field>& all) {
  if (is_first) {
    all = std::move(added);
    return true;
  }
  const auto is_alike = [](const Field& a, const Field& b) { return a.name == b.name && a.components == b.components; };
  if (!std::equal(all.begin(), all.end(), added.begin(), added.end(), is_alike)) return false;
  for (size_t i = 0; i < all.size(); ++i)
    all[i].values.insert(all[i].values.end(), added[i].values.begin(), added[i].values.end());
  return true;
}

}  // namespace

bool VtkPiece::has_tets() const { return std::any_of(types.begin(), types.end(), is_tet); }

std::string fault_of_positions(const std::vector<double>& positions) {
  const auto wrong = std::find_if(positions.begin(), positions.end(), [](double x) { return !std::isfinite(x); });
  if (wrong == positions.end()) return "";
  return "point " + std::to_string((wrong - positions.begin()) / 3) + " is not finite; correct it";
}

std::string fault_of_cells(const VtkPiece& piece) {
  int64_t previous = 0;
  for (size_t cell = 0; cell < piece.types.size(); ++cell) {
    std::string fault = fault_of_cell(piece.types[cell], piece.offsets[cell] - previous, cell);
    if (!fault.empty()) return fault;
    previous = piece.offsets[cell];
  }
  for (const int64_t point : piece.connectivity)
    if (point < 0 || point >= static_cast<int64_t>(piece.points()))
      return "a cell names point " + std::to_string(point) + " of " + std::to_string(piece.points()) +
             "; get a complete copy";
  return "";
}

bool append_piece(VtkPiece piece, bool keeps_tets, bool is_first, Vtu& grid) {
  std::vector<Vec3d>& vertices = keeps_tets ? grid.mesh.rest : grid.triangles.vertices;
  const int first_point = static_cast<int>(vertices.size());
  const Kept kept = kept_cells(piece, first_point, keeps_tets);
  for (size_t i = 0; i < piece.positions.size(); i += 3)
    vertices.push_back({{piece.positions[i], piece.positions[i + 1], piece.positions[i + 2]}});
  grid.mesh.tets.insert(grid.mesh.tets.end(), kept.tets.begin(), kept.tets.end());
  grid.mesh.mids.insert(grid.mesh.mids.end(), kept.mids.begin(), kept.mids.end());
  if (!keeps_tets) append_lines(piece, first_point, grid.segments);
  std::vector<Triangle>& triangles = grid.triangles.triangles;
  triangles.insert(triangles.end(), kept.triangles.begin(), kept.triangles.end());
  for (Field& field : piece.cell_fields) field = gathered(field, kept.source);
  return append_fields(is_first, std::move(piece.point_fields), grid.point_fields) &&
         append_fields(is_first, std::move(piece.cell_fields), grid.cell_fields);
}

std::string finish_grid(Vtu& grid) {
  std::vector<MidNodes>& mids = grid.mesh.mids;
  if (std::all_of(mids.begin(), mids.end(), [](const MidNodes& m) { return m[0] < 0; })) mids.clear();
  if (grid.mesh.tets.empty()) return "";
  for (const Field& field : grid.cell_fields) {
    if (field.name != "region" || field.components != 1) continue;
    for (const double value : field.values) {
      if (!(std::abs(value) <= std::numeric_limits<int>::max()) || value != std::floor(value))
        return "cell field 'region' holds " + std::to_string(value) +
               ", which is no whole number; rename the field if it is no label";
      grid.mesh.region.push_back(static_cast<int>(value));
    }
    break;
  }
  return "";
}

}  // namespace aspic
