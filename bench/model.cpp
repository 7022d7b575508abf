#include "bench/model.h"

#include <utility>

#include "energy/linear_load.h"
#include "energy/tet_elasticity.h"

namespace aspic::bench {

Model make_model(TetMesh mesh_to_take, const Substance& substance, std::vector<int> clamped) {
  constexpr double kDownwards = -9.81;  // [m/s^2]
  Model model;
  model.mesh = std::move(mesh_to_take);
  const TetMesh& mesh = model.mesh;
  model.bodies = {{"body", 0, mesh.vertex_count(), 0, mesh.tet_count()}};
  model.density.assign(mesh.tet_count(), substance.density);
  model.mass = std::make_unique<MassMatrix>(mesh, model.density, MassKind::consistent);

  const MaterialParameters parameters{.lame = lame_from_young_poisson(substance.young, substance.poisson)};
  model.elasticity.push_back(
      make_tet_elasticity(substance.material, mesh, 0, std::vector<MaterialParameters>(mesh.tet_count(), parameters)));

  std::vector<double> weight(3 * mesh.vertex_count());
  for (int t = 0; t < mesh.tet_count(); ++t) add_body_force(mesh, t, {0, substance.density * kDownwards, 0}, weight);
  model.loads.push_back(make_linear_load("gravity", std::move(weight)));

  Pin& clamp = model.pins.emplace_back();
  clamp.name = "clamp";
  clamp.vertices = std::move(clamped);
  return model;
}

State at_rest(const TetMesh& mesh) {
  State state;
  for (const Vec3d& X : mesh.rest) state.q.insert(state.q.end(), {X[0], X[1], X[2]});
  state.qdot.assign(state.q.size(), 0.0);
  return state;
}

}  // namespace aspic::bench
