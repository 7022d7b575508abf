#include "scene/sag.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dynamics/simulation.h"
#include "energy/linear_load.h"
#include "material/lame.h"
#include "mesh/components.h"

namespace aspic {
namespace {

constexpr double kLongStep = 1;  // [s]; what swings at more than a hertz comes to rest in it

// The vertices of `held`, and of every part that holds none of them.
std::vector<int> with_loose_parts(const TetMesh& mesh, std::vector<int> held) {
  std::vector<char> is_fixed(mesh.vertex_count(), 1);  // vertices of no tet stay fixed
  for (const Tet& tet : mesh.tets)
    for (const int v : tet) is_fixed[v] = 0;
  for (const int v : held) is_fixed[v] = 1;
  for (const std::vector<int>& part : tet_components(mesh)) {
    const bool is_loose = std::none_of(part.begin(), part.end(), [&](int t) {
      return std::any_of(mesh.tets[t].begin(), mesh.tets[t].end(), [&](int v) { return is_fixed[v] != 0; });
    });
    if (!is_loose) continue;
    for (const int t : part)
      for (const int v : mesh.tets[t]) is_fixed[v] = 1;
  }
  held.clear();
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (is_fixed[v]) held.push_back(v);
  return held;
}

Model model_of(TetMesh mesh, std::vector<int> held, const SagOptions& options) {
  Model model;
  model.mesh = std::move(mesh);
  const int tets = model.mesh.tet_count();
  model.bodies = {{"body", 0, model.mesh.vertex_count(), 0, tets}};
  model.density.assign(tets, options.density);
  model.mass = std::make_unique<MassMatrix>(model.mesh, model.density, MassKind::lumped);
  const std::vector<MaterialParameters> parameters(tets, {lame_from_young_poisson(options.young, options.poisson), {}});
  model.elasticity.push_back(make_tet_elasticity("linear", model.mesh, 0, parameters));
  std::vector<double> weight;
  for (const double mass : model.mass->vertex_mass())
    for (int r = 0; r < 3; ++r) weight.push_back(mass * options.gravity[r]);
  model.loads.push_back(make_linear_load("gravity", std::move(weight)));
  model.pins.push_back({"held", std::move(held), {}});
  return model;
}

}  // namespace

double sag(TetMesh mesh, std::vector<int> held, const SagOptions& options) {
  State start;
  for (const Vec3d& X : mesh.rest) start.q.insert(start.q.end(), {X[0], X[1], X[2]});
  start.qdot.assign(start.q.size(), 0.0);
  const std::vector<double> X = start.q;
  std::vector<int> fixed = with_loose_parts(mesh, std::move(held));
  // The end of a long step, so that what hangs by a hinge has an answer, too.
  SimulationOptions statics{.h = kLongStep, .integrator = "backward_euler"};
  statics.solver.minimize.tolerance = 1e-3;
  Simulation simulation(model_of(std::move(mesh), std::move(fixed), options), std::move(start), statics);
  if (!is_success(simulation.step().status)) return std::numeric_limits<double>::quiet_NaN();
  const std::vector<double>& q = simulation.state().q;
  double largest = 0;
  for (size_t i = 0; i < q.size(); i += 3)
    largest = std::max(largest, std::hypot(q[i] - X[i], q[i + 1] - X[i + 1], q[i + 2] - X[i + 2]));
  return largest;
}

}  // namespace aspic
