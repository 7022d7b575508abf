#include "dynamics/explanation_places.h"
#include "base/formatted.h"
#include "math/svd3.h"
#include "mesh/elements.h"
#include "mesh/tet_nodes.h"
#include "mesh/vertices.h"

#include <cmath>
#include <vector>

namespace aspic::places {
namespace {

// "vertex 12", "vertex 12 of body 'arm'": in the numbering of the body's mesh. `index` is the user's number.
std::string named(const Model& model, const char* kind, int index, int BodyRange::*first, int BodyRange::*count) {
  for (const BodyRange& body : model.bodies) {
    const int own = index - body.*first;
    if (own < 0 || own >= body.*count) continue;
    const std::string name = std::string(kind) + " " + std::to_string(own);
    return model.bodies.size() > 1 ? name + " of body '" + body.name + "'" : name;
  }
  return std::string(kind) + " " + std::to_string(index);
}

double signed_volume(const TetMesh& mesh, int tet, std::span<const double> x) {
  const auto [a, b, c, d] = center_corners(mesh, tet, x);
  return determinant(from_columns(b - a, c - a, d - a)) / 6;
}

}  // namespace

std::string text(double number) { return three_digits(number); }

double power_of_ten_above(double number) { return std::pow(10, std::ceil(std::log10(number))); }

std::string point_text(std::span<const double> x, int vertex) {
  const size_t i = 3 * static_cast<size_t>(vertex);
  return "(" + text(x[i]) + ", " + text(x[i + 1]) + ", " + text(x[i + 2]) + ") m";
}

std::string vertex_name(const Model& model, int vertex) {
  return named(model, "vertex", model.numbering.vertex.to_user(vertex), &BodyRange::first_vertex,
               &BodyRange::vertex_count);
}
std::string tet_name(const Model& model, int tet) {
  if (const int segment = tet - model.mesh.first_segment(); segment >= 0)
    return named(model, "segment", segment, &BodyRange::first_segment, &BodyRange::segment_count);
  if (const int triangle = tet - model.mesh.tet_count(); triangle >= 0)
    return named(model, "triangle", triangle, &BodyRange::first_triangle, &BodyRange::triangle_count);
  return named(model, "tet", model.numbering.tet.to_user(tet), &BodyRange::first_tet, &BodyRange::tet_count);
}

WorstTriangle overstretched(const Model& model, std::span<const double> x) {
  const TetMesh& mesh = model.mesh;
  const auto n = static_cast<size_t>(mesh.element_count());
  TetFields fields{std::vector<double>(n), std::vector<double>(n), std::vector<double>(6 * n), std::vector<double>(n)};
  for (const auto& V : model.elasticity) V->evaluate(x, fields);
  WorstTriangle worst;
  for (int t = mesh.tet_count(); t < mesh.first_segment(); ++t) {
    if (std::isfinite(fields.energy_density[t])) continue;
    const double stretch = svd3(deformation_gradient(mesh, t, x)).s[0];
    if (stretch > worst.stretch) worst = {t, stretch};
  }
  return worst;
}

WorstTet most_compressed(const TetMesh& mesh, std::span<const double> x) {
  const std::vector<double> rest = rest_positions(mesh);
  WorstTet worst;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const double det_F = signed_volume(mesh, t, x) / signed_volume(mesh, t, rest);
    if (!(det_F >= worst.det_F)) worst = {t, det_F};
  }
  return worst;
}

std::string compressed_place(const Model& model, std::span<const double> x) {
  const WorstTet worst = most_compressed(model.mesh, x);
  if (worst.tet < 0) return "";
  return tet_name(model, worst.tet) + (worst.det_F > 0 ? " is compressed most: " : " is inverted: ") +
         text(worst.det_F) + " of its volume";
}

}  // namespace aspic::places
