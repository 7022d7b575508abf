// Points, cells and fields of VTK grids, as the XML and the legacy format store them.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/vtu.h"

namespace aspic {

// Cell types of VTK [vtkCellType.h]. Types 1 to 4 are vertices and lines, 21 to 23 quadratic edges and faces.
enum VtkCellType : int64_t {
  kVtkVertex = 1,
  kVtkPolyVertex = 2,
  kVtkLine = 3,
  kVtkPolyLine = 4,
  kVtkTriangle = 5,
  kVtkStrip = 6,
  kVtkPolygon = 7,
  kVtkQuad = 9,
  kVtkTet = 10,
  kVtkQuadraticEdge = 21,
  kVtkQuadraticQuad = 23,
  kVtkQuadraticTet = 24
};

// One piece of a grid.
struct VtkPiece {
  std::vector<double> positions;  // 3 per point [m]
  std::vector<int64_t> connectivity;
  std::vector<int64_t> offsets;  // end of each cell in `connectivity`
  std::vector<int64_t> types;    // one per cell
  std::vector<Field> point_fields, cell_fields;

  size_t points() const { return positions.size() / 3; }
  bool has_tets() const;
};

// Return what is wrong with the positions or the cells; empty if nothing is.
std::string fault_of_positions(const std::vector<double>& positions);
std::string fault_of_cells(const VtkPiece& piece);

// Appends the points of a piece, its tets or otherwise its faces, and their fields. Returns false if its fields differ
// from those of the `first` piece. Requires a piece without fault.
bool append_piece(VtkPiece piece, bool keeps_tets, bool is_first, Vtu& grid);

// Sets the regions after the last piece. Returns what is wrong with the field "region"; empty if nothing is.
std::string finish_grid(Vtu& grid);

}  // namespace aspic
