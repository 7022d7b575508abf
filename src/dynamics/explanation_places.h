// Names and places in the words of an explanation.
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

std::string text(double number);           // three digits
double power_of_ten_above(double number);  // the least that is not below it
std::string point_text(std::span<const double> x, int vertex);
// "vertex 12", "tet 12 of body 'arm'": by the numbers of the body's own mesh.
std::string vertex_name(const Model& model, int vertex);
std::string tet_name(const Model& model, int tet);
WorstTet most_squashed(const TetMesh& mesh, std::span<const double> x);
std::string squashed_place(const Model& model, std::span<const double> x);  // that tet, in words

}  // namespace aspic::places
