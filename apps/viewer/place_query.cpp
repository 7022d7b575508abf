#include "viewer/replies.h"

#include "energy/energy.h"
#include "mesh/elements.h"
#include "mesh/tet_nodes.h"
#include "viewer/scene_json.h"

namespace aspic::viewer {
namespace {

Json rows_of(const Mat3d& A) {
  Json rows = Json::array();
  for (int r = 0; r < 3; ++r) rows.push_back({A(r, 0), A(r, 1), A(r, 2)});
  return rows;
}

// The corners of a tet or a triangle.
std::span<const int> corners_of(const TetNodes& nodes) { return std::span(nodes.node).first(std::min(nodes.count, 4)); }

Json corner_positions(const Side& side, int element) {
  Json list = Json::array();
  const TetNodes nodes = nodes_of(side.model().mesh, element);
  for (const int v : corners_of(nodes)) list.push_back(json_of(aspic::point(side.positions(), v)));
  return list;
}

Mat3d cauchy_of(const TetFields& fields, int tet) {
  const double* s = &fields.cauchy[6 * static_cast<size_t>(tet)];  // xx yy zz xy yz zx
  return {{s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2]}};
}

Json value_of(const Model& model, const char* field, int tet) {
  const std::vector<double>* values = tet_field(model, field);
  return values ? Json((*values)[tet]) : Json();
}

}  // namespace

Json vertex_reply(const ShownSide& shown, int vertex) {
  const Side& side = shown.side;
  const Surface& surface = shown.surface;
  const Model& model = side.model();
  const View view = shown.view();
  Json values = Json::object();
  FieldValues evaluate;
  std::vector<float> all(surface.rest.size());
  for (const Field& field : shown.fields()) {
    evaluate.evaluate(field.name, view, surface, all);
    values[field.name] = all[vertex];
  }
  double mass = 0;
  const Carrier& carrier = surface.carrier[vertex];
  for (int n = 0; n < carrier.count; ++n) mass += carrier.weight[n] * model.mass->vertex_mass()[carrier.vertex[n]];
  const int user = surface.is_fine ? -1 : model.numbering.vertex.to_user(surface.anchor(vertex));
  return {{"vertex", user},
          {"first_entry", surface.is_fine ? -1 : 3 * user},
          {"rest", json_of(surface.rest[vertex])},
          {"position", json_of(surface.position(vertex, view.x))},
          {"velocity", json_of(surface.carried(vertex, side.simulation().state().qdot))},
          {"mass", mass},
          {"pinned", side.pins().has(surface.anchor(vertex))},
          {"values", std::move(values)}};
}

Json tet_reply(const ShownSide& shown, int triangle) {
  const Side& side = shown.side;
  const Model& model = side.model();
  const int t = shown.surface.tet[triangle];
  const TetFields fields = tet_fields_at(shown.view());
  const Mat3d F = deformation_gradient(model.mesh, t, side.positions());
  Json vertices = Json::array();
  const TetNodes nodes = nodes_of(model.mesh, t);
  for (const int v : corners_of(nodes)) vertices.push_back(model.numbering.vertex.to_user(v));
  const double size = element_volume(model.mesh, t);
  return {{"tet", model.numbering.tet.to_user(t)},
          {"corners", std::move(vertices)},
          {"positions", corner_positions(side, t)},
          {"F", rows_of(F)},
          {"J", determinant(F)},
          {"stretches", json_of(stretches(F))},
          {"cauchy", rows_of(cauchy_of(fields, t))},
          {"von_mises", fields.von_mises[t]},
          {"energy_density", fields.energy_density[t]},
          {"energy", size * fields.energy_density[t]},
          {"volume", size},
          {"quality", element_quality(model.mesh, t)},
          {"young", value_of(model, "young", t)},
          {"poisson", value_of(model, "poisson", t)},
          {"density", model.density[t]}};
}

Json worst_reply(const ShownSide& shown) {
  const Side& side = shown.side;
  const Model& model = side.model();
  const TetFields fields = tet_fields_at(shown.view());
  Json items = Json::array();
  const auto add_tet = [&](const char* what, const char* unit, const std::vector<double>& values, double sign) {
    int worst = 0;
    for (int t = 1; t < model.mesh.element_count(); ++t)
      if (sign * values[t] > sign * values[worst]) worst = t;
    items.push_back({{"what", what},
                     {"value", values[worst]},
                     {"unit", unit},
                     {"tet", model.numbering.tet.to_user(worst)},
                     {"vertex", -1},
                     {"positions", corner_positions(side, worst)}});
  };
  std::vector<double> quality;
  for (int t = 0; t < model.mesh.element_count(); ++t) quality.push_back(element_quality(model.mesh, t));
  add_tet("smallest det F", "", fields.det_F, -1);
  add_tet("largest energy density", "J/m^3", fields.energy_density, 1);
  add_tet("largest von Mises stress", "Pa", fields.von_mises, 1);
  add_tet("worst shape at rest", "", quality, -1);
  if (const StepRow* last = side.history().rows().last(); last && last->report.worst_vertex >= 0)
    items.push_back({{"what", "largest residual of the last step"},
                     {"value", last->report.worst_residual},
                     {"unit", "N"},
                     {"tet", -1},
                     {"vertex", model.numbering.vertex.to_user(last->report.worst_vertex)},
                     {"positions", Json::array({json_of(aspic::point(side.positions(), last->report.worst_vertex))})}});
  return {{"items", std::move(items)}};
}

}  // namespace aspic::viewer
