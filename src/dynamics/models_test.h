// Small models that several tests share.
#pragma once
#include <cmath>
#include <functional>
#include <string>

#include "dynamics/integrator.h"
#include "dynamics/simulation.h"
#include "energy/linear_load.h"
#include "energy/rayleigh_damping.h"
#include "energy/springs.h"
#include "material/lame.h"
#include "mesh/generators.h"

namespace aspic::testing_models {

struct ModelOptions {
  std::string material = "neo_hookean_log";
  double young = 1e6, poisson = 0.4, density = 1000;
  MassKind mass = MassKind::consistent;
  Vec3d gravity{{0, -9.81, 0}};
};

inline Model make_model(TetMesh mesh, const ModelOptions& options) {
  Model model;
  model.mesh = std::move(mesh);
  const int tets = model.mesh.tet_count(), vertices = model.mesh.vertex_count();
  model.bodies = {{"body", 0, vertices, 0, tets}};
  model.density.assign(tets, options.density);
  model.mass = std::make_unique<MassMatrix>(model.mesh, model.density, options.mass);
  const MaterialParameters p{lame_from_young_poisson(options.young, options.poisson), {}};
  model.elasticity.push_back(
      make_tet_elasticity(options.material, model.mesh, 0, std::vector<MaterialParameters>(tets, p)));
  std::vector<double> weight;
  for (int v = 0; v < vertices; ++v)
    for (int r = 0; r < 3; ++r) weight.push_back(model.mass->vertex_mass()[v] * options.gravity[r]);
  model.loads.push_back(make_linear_load("gravity", weight));
  return model;
}

inline std::vector<int> vertices_where(const TetMesh& mesh, const std::function<bool(const Vec3d&)>& predicate) {
  std::vector<int> vertices;
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (predicate(mesh.rest[v])) vertices.push_back(v);
  return vertices;
}

inline State at_rest(const TetMesh& mesh) {
  State state;
  for (const Vec3d& X : mesh.rest) state.q.insert(state.q.end(), {X[0], X[1], X[2]});
  state.qdot.assign(state.q.size(), 0.0);
  return state;
}

// The box beam of the benchmarks: [0, 4] x [0, 1] x [0, 1] m, 4n x n x n cells, face x = 0 fixed.
inline Model beam(int n, const ModelOptions& options = {}) {
  Model model = make_model(make_box({{0, 0, 0}}, {{4, 1, 1}}, {4 * n, n, n}), options);
  model.pins.push_back({"wall", vertices_where(model.mesh, [](const Vec3d& X) { return X[0] < 1e-9; }), {}});
  return model;
}

inline Model damped_beam_with_moving_pins_and_targets(int n = 2) {  // n >= 2
  Model model = beam(n, {.young = 1e5, .poisson = 0.3});
  model.pins.push_back({"crank", vertices_where(model.mesh, [](const Vec3d& X) { return X[0] > 4 - 1e-9; }),
                        [](const Vec3d& X, double t) {
                          return X + Vec3d{{0, 0.2 * std::sin(8 * t), 0}};
                        }});
  model.loads.push_back(make_point_springs("pull", {{20, 500, [](double t) { return Vec3d{{2, t, 0}}; }}}));
  model.damping.push_back(make_rayleigh_damping(*model.mass, 0.5, model.elasticity[0].get(), 1e-3));
  model.damping.push_back(make_strain_rate_damping(model.mesh, 0, std::vector<double>(model.mesh.tet_count(), 50.0)));
  return model;
}

inline bool is_explicit(const std::string& integrator) { return !make_integrator(integrator)->is_implicit(); }

inline Simulation simulate(Model model, SimulationOptions options = {}) {
  State start = at_rest(model.mesh);
  return Simulation(std::move(model), std::move(start), std::move(options));
}

}  // namespace aspic::testing_models
