#include "results/run_directory_frame.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "contact/barrier.h"
#include "dynamics/internal_terms.h"
#include "dynamics/step_fields.h"
#include "io/vtu.h"
#include "math/symmetric_eigen.h"
#include "mesh/elements.h"
#include "mesh/tet_nodes.h"

namespace aspic {
namespace {

std::vector<double> displacement(const TetMesh& mesh, const std::vector<double>& q) {
  std::vector<double> u(q.size());
  for (size_t i = 0; i < q.size(); ++i) u[i] = q[i] - mesh.rest[i / 3][static_cast<int>(i % 3)];
  return u;
}

// The index of the body of each element.
std::vector<double> body_of_elements(const Model& model) {
  std::vector<double> body(static_cast<size_t>(model.mesh.element_count()), -1);
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const BodyRange& range = model.bodies[b];
    const auto index = static_cast<double>(b);
    std::fill_n(body.begin() + range.first_tet, range.tet_count, index);
    std::fill_n(body.begin() + model.mesh.tet_count() + range.first_triangle, range.triangle_count, index);
    std::fill_n(body.begin() + model.mesh.first_segment() + range.first_segment, range.segment_count, index);
  }
  return body;
}

// The label of each tet; 0 for sheets and rods.
std::vector<double> region_of_elements(const TetMesh& mesh) {
  std::vector<double> region(mesh.region.begin(), mesh.region.end());
  region.resize(static_cast<size_t>(mesh.element_count()), 0);
  return region;
}

// Returns the pressure, minus a third of the trace of the stress, averaged by volume over the tets at each vertex:
// pressures of single tets that are nearly incompressible may oscillate.
std::vector<double> pressure_of_vertices(const TetMesh& mesh, const std::vector<double>& cauchy) {
  std::vector<double> pressure(mesh.rest.size(), 0.0), size(mesh.rest.size(), 0.0);
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const double V = volume(mesh, t), *stress = &cauchy[6 * static_cast<size_t>(t)];
    for (const int v : nodes_of(mesh, t)) {
      pressure[v] -= V * (stress[0] + stress[1] + stress[2]) / 3;
      size[v] += V;
    }
  }
  for (size_t v = 0; v < size.size(); ++v)
    if (size[v] > 0) pressure[v] /= size[v];
  return pressure;
}

// In the storage order of the model.
std::vector<Field> cell_fields(const Simulation& simulation, TetFields tet, FieldType real) {
  const Model& model = simulation.model();
  constexpr FieldType kLabel = FieldType::int32;
  std::vector<Field> fields;
  fields.push_back({"energy_density", 1, std::move(tet.energy_density), real});
  fields.push_back({"det_F", 1, std::move(tet.det_F), real});
  fields.push_back({"cauchy", 6, std::move(tet.cauchy), real});
  fields.push_back({"von_mises", 1, std::move(tet.von_mises), real});
  fields.push_back({"body", 1, body_of_elements(model), kLabel});
  fields.push_back({"region", 1, region_of_elements(model.mesh), kLabel});
  if (!model.density.empty()) fields.push_back({"density", 1, model.density, real});
  for (const auto& [name, values] : model.tet_fields) fields.push_back({name, 1, values, real});
  return fields;
}

// The time, and the fields of the report for frames. Names are stored as indices, see docs/formats.md.
std::vector<Field> file_fields(double time, const StepReport* report) {
  std::vector<Field> fields = {{"TimeValue", 1, {time}, FieldType::float64}};  // ParaView's name
  if (!report) return fields;
  for (const StepField& field : step_fields()) {
    if (!field.is_in(StepOutput::frame)) continue;
    std::vector<double> values = field.numbers(*report);
    const int components = static_cast<int>(values.size());
    const FieldType type = field.type == StepFieldType::real ? FieldType::float64 : FieldType::int32;
    fields.push_back({std::string(field.name), components, std::move(values), type});
  }
  return fields;
}

// Contact at the vertices, in the storage order of the model.
void add_contact_fields(const Simulation& simulation, FieldType real, std::vector<Field>& fields) {
  const Model& model = simulation.model();
  if (!model.contact) return;
  const size_t n = model.mesh.rest.size();
  Field pressure{"contact_pressure", 1, std::vector<double>(n, 0.0), real};
  Field gap{"contact_gap", 1, std::vector<double>(n, std::numeric_limits<double>::quiet_NaN()), real};
  for (const ContactPoint& point : model.contact->contact_points(simulation.state().q, simulation.obstacle_time())) {
    if (point.row < 0) continue;
    pressure.values[point.row] = point.pressure;
    gap.values[point.row] = point.gap;
  }
  fields.push_back(std::move(pressure));
  fields.push_back(std::move(gap));
}

// cauchy: 6 per element. Writes the eigenvalues of each, largest first.
void add_mechanics(const Simulation& simulation, std::span<const double> cauchy, FieldType real, VtuFields& fields) {
  const TetMesh& mesh = simulation.model().mesh;
  Field F{"F", 9, {}, real}, strain{"strain", 6, {}, real}, principal{"principal_stress", 3, {}, real};
  for (int t = 0; t < mesh.element_count(); ++t) {
    const Mat3d F_t = deformation_gradient(mesh, t, simulation.state().q);
    const Mat3d E = 0.5 * (transpose(F_t) * F_t - identity3<double>()), rows = transpose(F_t);
    F.values.insert(F.values.end(), rows.a, rows.a + 9);
    strain.values.insert(strain.values.end(), {E(0, 0), E(1, 1), E(2, 2), E(0, 1), E(1, 2), E(2, 0)});
    const double* s = &cauchy[6 * static_cast<size_t>(t)];
    std::array<double, 3> values =
        symmetric_eigen<3, double>({s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2]}).values;
    std::sort(values.rbegin(), values.rend());
    principal.values.insert(principal.values.end(), values.begin(), values.end());
  }
  for (Field* field : {&F, &strain, &principal}) fields.cell_fields.push_back(std::move(*field));
  fields.point_fields.push_back({"reaction", 3, simulation.model().of_vertices(simulation.reactions()), real});
}

}  // namespace

VtuFields frame_fields(const Simulation& simulation, const StepReport* report, FrameContents contents) {
  const FieldType real = contents.double_precision ? FieldType::float64 : FieldType::float32;
  const Model& model = simulation.model();
  const State& state = simulation.state();
  VtuFields fields;
  fields.point_fields = {{"displacement", 3, displacement(model.mesh, model.of_vertices(state.q)), real},
                         {"velocity", 3, model.of_vertices(state.qdot), real}};
  TetFields tet_fields = simulation.tet_fields();
  if (!model.mesh.mids.empty())
    fields.point_fields.push_back({"pressure", 1, pressure_of_vertices(model.mesh, tet_fields.cauchy), real});
  add_contact_fields(simulation, real, fields.point_fields);
  if (contents.mechanics) add_mechanics(simulation, tet_fields.cauchy, real, fields);
  for (Field& field : cell_fields(simulation, std::move(tet_fields), real))
    fields.cell_fields.push_back(std::move(field));
  if (std::vector<double> bending = bending_density(model, state.q, state.internal); !bending.empty())
    fields.cell_fields.push_back({"bending_density", 1, std::move(bending), real});
  if (report && !report->mesh_density.empty())
    fields.cell_fields.push_back({"mesh_error", 1, report->mesh_density, real});
  fields.file_fields = file_fields(state.time, report);
  return fields;
}

void write_frame(const std::filesystem::path& path, const Simulation& simulation, const StepReport* report,
                 FrameContents contents) {
  const Model& model = simulation.model();
  const auto& [vertex, tet] = model.numbering;
  VtuFields fields = frame_fields(simulation, report, contents);
  for (Field& field : fields.point_fields) field.values = vertex.to_user(field.values, field.components);
  for (Field& field : fields.cell_fields) field.values = tet.to_user(field.values, field.components);
  const TetMesh mesh = to_user(model.numbering, model.mesh);
  write_vtu(path, vertex.to_user(model.of_vertices(simulation.state().q), 3), mesh, fields);
}

}  // namespace aspic
