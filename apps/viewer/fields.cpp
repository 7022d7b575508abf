#include "viewer/fields.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "dynamics/internal_terms.h"
#include "energy/energy.h"
#include "math/eigen3.h"
#include "mesh/elements.h"

namespace aspic::viewer {
namespace {

const std::string kContactPressure = "contact_pressure";

void evaluate_elasticity(const View& view, TetFields& fields) {
  const auto tets = static_cast<size_t>(view.simulation.model().mesh.element_count());
  fields.energy_density.assign(tets, 0.0);
  fields.det_F.assign(tets, 1.0);
  fields.cauchy.assign(6 * tets, 0.0);
  fields.von_mises.assign(tets, 0.0);
  for (const auto& V : view.simulation.model().elasticity) V->evaluate(view.x, fields);
}

// A field of every model. One of the three members computes it.
struct KnownField {
  Field field;
  double (*at_vertex)(const View& view, const Surface& surface, int vertex) = nullptr;
  double (*at_tet)(const View& view, int tet) = nullptr;
  std::vector<double> TetFields::*elastic = nullptr;
};

const std::vector<KnownField>& known_fields() {
  static const std::vector<KnownField> list = {
      {.field = {"displacement", "displacement", "m"},
       .at_vertex = [](const View& view, const Surface& surface,
                       int v) { return norm(surface.position(v, view.x) - surface.rest[v]); }},
      {.field = {"speed", "speed", "m/s"},
       .at_vertex = [](const View& view, const Surface& surface,
                       int v) { return norm(surface.carried(v, view.simulation.state().qdot)); }},
      {.field = {"von_mises", "von Mises stress", "Pa"}, .elastic = &TetFields::von_mises},
      {.field = {"energy_density", "energy density", "J/m^3"}, .elastic = &TetFields::energy_density},
      {.field = {"det_F", "volume ratio det F", "", true, 1}, .elastic = &TetFields::det_F},
      {.field = {"stretch", "largest stretch", "", true, 1},
       .at_tet = [](const View& view,
                    int t) { return largest_stretch(deformation_gradient(view.simulation.model().mesh, t, view.x)); }},
      {.field = {"density", "density at rest", "kg/m^3"},
       .at_tet = [](const View& view, int t) { return view.simulation.model().density[t]; }},
      {.field = {"quality", "quality of elements (1 = regular)", ""},
       .at_tet = [](const View& view, int t) { return element_quality(view.simulation.model().mesh, t); }}};
  return list;
}

const KnownField* find_field(const std::string& name) {
  for (const KnownField& known : known_fields())
    if (known.field.name == name) return &known;
  return nullptr;
}

// The fields that a material exports and that have a label.
const Field kMaterialFields[] = {{.name = "young", .label = "Young's modulus", .unit = "Pa", .is_log = true},
                                 {.name = "poisson", .label = "Poisson's ratio", .unit = ""},
                                 {.name = "fibre_x", .label = "fibres along x", .unit = ""},
                                 {.name = "fibre_y", .label = "fibres along y", .unit = ""},
                                 {.name = "fibre_z", .label = "fibres along z", .unit = ""}};

}  // namespace

std::vector<Field> fields_of(const Model& model, bool has_mesh_error) {
  std::vector<Field> fields;
  for (const KnownField& known : known_fields()) fields.push_back(known.field);
  if (model.contact) fields.push_back({kContactPressure, "contact pressure", "Pa"});
  if (model.mesh.element_count() > model.mesh.tet_count())
    fields.push_back({std::string(kBendingDensity), "bending energy density", "J/m^3"});
  if (has_mesh_error) fields.push_back({std::string(kMeshError), "mesh error", "J/m^3"});
  for (const auto& [name, unused] : model.tet_fields) {
    Field& field = fields.emplace_back(Field{name, name, ""});
    for (const Field& labeled : kMaterialFields)
      if (labeled.name == name) field = labeled;
  }
  return fields;
}

const std::vector<double>* tet_field(const Model& model, std::string_view name) {
  for (const auto& [known, values] : model.tet_fields)
    if (known == name) return &values;
  return nullptr;
}

std::vector<ContactPoint> contact_points(const View& view) {
  const Barrier* contact = view.simulation.model().contact;
  return contact ? contact->contact_points(view.x, view.simulation.obstacle_time()) : std::vector<ContactPoint>();
}

TetFields tet_fields_at(const View& view) {
  TetFields fields;
  evaluate_elasticity(view, fields);
  return fields;
}

Vec3d stretches(const Mat3d& F) {
  const Mat3d C = transpose(F) * F;
  for (const double entry : C.a)
    if (!std::isfinite(entry)) return {{entry, entry, entry}};
  const Vec3d squared = symmetric_eigen(C).values;
  const auto root = [](double s) { return std::sqrt(std::max(s, 0.0)); };
  return {{root(squared[2]), root(squared[1]), root(squared[0])}};
}

double largest_stretch(const Mat3d& F) {
  Mat3d C = transpose(F) * F;
  const double mean = trace(C) / 3;
  for (int i = 0; i < 3; ++i) C(i, i) -= mean;
  const double p = std::sqrt(squared_norm(C) / 6);
  if (p == 0) return std::sqrt(mean);
  const double r = std::clamp(determinant(C) / (2 * p * p * p), -1.0, 1.0);
  return std::sqrt(std::max(mean + 2 * p * std::cos(std::acos(r) / 3), 0.0));
}

std::span<const double> FieldValues::tet_values(const std::string& field, const View& view) {
  const Model& model = view.simulation.model();
  if (field == kMeshError && !view.mesh_error.empty()) return view.mesh_error;
  if (field == kBendingDensity) {
    if (!view.bending.empty()) return view.bending;
    tet_ = bending_density(model, view.x, view.simulation.state().internal);
    if (!tet_.empty()) return tet_;
  }
  if (const auto* values = tet_field(model, field)) return *values;
  const KnownField* known = find_field(field);
  if (!known || known->elastic) {  // a field that no longer exists shows det F
    evaluate_elasticity(view, fields_);
    return fields_.*(known ? known->elastic : &TetFields::det_F);
  }
  const int elements = model.mesh.element_count();
  tet_.resize(elements);
  parallel_for(elements, [&](int t) { tet_[t] = known->at_tet(view, t); });
  return tet_;
}

void FieldValues::evaluate(const std::string& field, const View& view, const Surface& surface,
                           std::span<float> values) {
  if (const KnownField* known = find_field(field); known && known->at_vertex) {
    for (int v = 0; v < surface.vertex_count(); ++v) values[v] = static_cast<float>(known->at_vertex(view, surface, v));
    return;
  }
  if (field == kContactPressure) {
    pressure_.assign(view.x.size(), 0.0);  // along the first axis
    for (const ContactPoint& contact : contact_points(view))
      if (contact.row >= 0) pressure_[3 * static_cast<size_t>(contact.row)] = contact.pressure;
    for (int v = 0; v < surface.vertex_count(); ++v) values[v] = static_cast<float>(surface.carried(v, pressure_)[0]);
    return;
  }
  const std::span<const double> of_tet = tet_values(field, view);
  const TetMesh& mesh = view.simulation.model().mesh;
  for (int v = 0; v < surface.vertex_count(); ++v) {
    double sum = 0, weight = 0;
    for (const int t : surface.tets_at(v)) {
      const double w = element_volume(mesh, t);
      sum += w * of_tet[t];
      weight += w;
    }
    values[v] = static_cast<float>(sum / weight);
  }
}

}  // namespace aspic::viewer
