#include "verify/models.h"

#include <cmath>
#include <stdexcept>

#include "base/check.h"
#include "energy/linear_load.h"
#include "material/lame.h"

namespace aspic::verify {

MaterialParameters parameters_of(const std::string& material, double young, double poisson) {
  MaterialParameters p{lame_from_young_poisson(young, poisson), {}};
  const auto& extra = material_info(material).extra;
  for (size_t k = 0; k < extra.size(); ++k) p.extra[k] = extra[k].fallback;
  return p;
}

Model make_model(TetMesh mesh, const ModelOptions& options) {
  Model model;
  model.mesh = std::move(mesh);
  const int tets = model.mesh.tet_count(), vertices = model.mesh.vertex_count();
  model.bodies = {{"body", 0, vertices, 0, tets}};
  model.density.assign(tets, options.density);
  model.mass = std::make_unique<MassMatrix>(model.mesh, model.density, options.mass);
  const std::vector<MaterialParameters> parameters(tets,
                                                   parameters_of(options.material, options.young, options.poisson));
  model.elasticity.push_back(make_tet_elasticity(options.material, model.mesh, 0, parameters));
  std::vector<double> weight;
  for (int v = 0; v < vertices; ++v)
    for (int r = 0; r < 3; ++r) weight.push_back(model.mass->vertex_mass()[v] * options.gravity[r]);
  model.loads.push_back(make_linear_load("gravity", weight));
  return model;
}

std::vector<int> vertices_where(const TetMesh& mesh, const std::function<bool(const Vec3d&)>& predicate) {
  std::vector<int> vertices;
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (predicate(mesh.rest[v])) vertices.push_back(v);
  return vertices;
}

std::vector<double> at_vertices(const TetMesh& mesh, const std::function<Vec3d(const Vec3d&)>& f) {
  std::vector<double> values;
  for (const Vec3d& X : mesh.rest) {
    const Vec3d v = f(X);
    values.insert(values.end(), {v[0], v[1], v[2]});
  }
  return values;
}

State at_rest(const TetMesh& mesh) {
  State state;
  state.q = at_vertices(mesh, [](const Vec3d& X) { return X; });
  state.qdot.assign(state.q.size(), 0.0);
  return state;
}

Simulation simulate(Model model, SimulationOptions options) {
  State start = at_rest(model.mesh);
  return Simulation(std::move(model), std::move(start), std::move(options));
}

void take_steps(Simulation& simulation, int count, const std::string& what) {
  for (int i = 0; i < count; ++i) {
    const StepReport report = simulation.step();
    if (!is_success(report.status))
      throw std::runtime_error(what + ": step " + std::to_string(report.step) + " did not converge: it is " +
                               std::string(to_string(report.status)));
  }
}

std::vector<Mode> lowest_modes(const Model& model, int count) {
  Modes found = vibration_modes(model, at_rest(model.mesh).q, count);
  if (found.status != ModesStatus::converged) throw std::runtime_error(message(found.status));
  return std::move(found.modes);
}

std::vector<double> frequencies(const Model& model, int count) {
  std::vector<double> found;
  for (const Mode& mode : lowest_modes(model, count)) found.push_back(mode.frequency);
  return found;
}

double largest(std::span<const double> values) {
  double most = 0;
  for (const double x : values) {
    if (std::isnan(x)) return x;
    most = std::fmax(most, std::abs(x));
  }
  return most;
}

double largest_difference(std::span<const double> a, std::span<const double> b) {
  ASPIC_CHECK(a.size() == b.size());
  std::vector<double> d(a.size());
  for (size_t i = 0; i < a.size(); ++i) d[i] = a[i] - b[i];
  return largest(d);
}

}  // namespace aspic::verify
