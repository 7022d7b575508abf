// Names and locations in explanations.
#pragma once
#include <limits>
#include <span>
#include <string>

#include "dynamics/model.h"

namespace aspic::places {

struct WorstTet {
  int tet = -1;
  double det_F = std::numeric_limits<double>::infinity();
};

std::string text(double number);           // three significant digits
double power_of_ten_above(double number);  // smallest power of ten >= number
std::string point_text(std::span<const double> x, int vertex);
// "vertex 12", "tet 12 of body 'arm'": in the numbering of the body's mesh.
std::string vertex_name(const Model& model, int vertex);
std::string tet_name(const Model& model, int tet);
WorstTet most_compressed(const TetMesh& mesh, std::span<const double> x);
struct WorstTriangle {
  int element = -1;
  double stretch = 0;  // larger principal stretch
};

// Returns the most stretched triangle with infinite energy.
WorstTriangle overstretched(const Model& model, std::span<const double> x);
std::string compressed_place(const Model& model, std::span<const double> x);  // describes that tet

}  // namespace aspic::places
