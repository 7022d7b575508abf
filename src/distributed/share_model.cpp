#include "distributed/share_model.h"

#include <algorithm>

#include "base/check.h"
#include "distributed/shared_terms.h"
#include "energy/linear_load.h"

namespace aspic::distributed {
namespace {

// The own vertices of a body, and its local tets.
BodyRange local_body(const BodyRange& whole, const MeshShare& share, const MeshShare::Body& tets) {
  const int first = std::max(whole.first_vertex, share.first());
  const int last = std::min(whole.first_vertex + whole.vertex_count, share.first() + share.own());
  return {.name = whole.name,
          .first_vertex = std::max(0, first - share.first()),
          .vertex_count = std::max(0, last - first),
          .first_tet = tets.first_tet,
          .tet_count = tets.counted + tets.halo};
}

std::unique_ptr<TetElasticity> local_elasticity(const Model& whole, size_t body, const std::string& material,
                                                const MeshShare& share, const Model& local) {
  const MeshShare::Body& tets = share.bodies[body];
  const std::span<const MaterialParameters> all = whole.elasticity[body]->parameters();
  std::vector<MaterialParameters> parameters;
  for (int t = tets.first_tet; t < tets.first_tet + tets.counted + tets.halo; ++t)
    parameters.push_back(all[share.tet[t] - whole.bodies[body].first_tet]);
  const std::span<const MaterialParameters> local_parameters(parameters);
  ElasticityOfRank parts;
  parts.counted = make_tet_elasticity(material, local.mesh, tets.first_tet, local_parameters.first(tets.counted));
  parts.halo =
      make_tet_elasticity(material, local.mesh, tets.first_tet + tets.counted, local_parameters.subspan(tets.counted));
  return make_shared_elasticity(std::move(parts), local.share);
}

std::unique_ptr<Energy> local_load(const Model& whole, const Energy& load, const MeshShare& share,
                                   const Share& of_model) {
  ASPIC_CHECK(load.has_constant_gradient());
  const std::vector<double> x(3 * whole.mesh.rest.size());
  std::vector<double> force(x.size());
  ActiveTerm(load).add_gradient(x, -1, force);
  std::vector<double> local = local_part(force, share);
  std::fill(local.begin() + 3 * static_cast<std::ptrdiff_t>(share.own()), local.end(), 0.0);
  return make_shared_load(make_linear_load(std::string(load.name()), std::move(local)), of_model);
}

// Directions of a pin hold for all its vertices.
Pin local_pin(const Pin& whole, const MeshShare& share) {
  Pin pin = whole;
  pin.vertices.clear();
  for (const int v : whole.vertices)
    if (const int local = share.local(v); local >= 0) pin.vertices.push_back(local);
  return pin;
}

}  // namespace

Model share_model(const Model& whole, const std::vector<std::string>& materials, const MeshShare& share,
                  const MpiRanks& ranks) {
  Model local;
  local.share = Share(ranks, share.first(), share.own());
  local.mesh = local_mesh(whole.mesh, share);
  for (size_t b = 0; b < whole.bodies.size(); ++b)
    local.bodies.push_back(local_body(whole.bodies[b], share, share.bodies[b]));
  for (const int t : share.tet) local.density.push_back(whole.density[t]);
  local.mass = std::make_unique<MassMatrix>(local.mesh, local.density, whole.mass->kind());
  for (size_t b = 0; b < whole.bodies.size(); ++b)
    local.elasticity.push_back(local_elasticity(whole, b, materials[b], share, local));
  for (const auto& load : whole.loads) local.loads.push_back(local_load(whole, *load, share, local.share));
  for (const Pin& pin : whole.pins) local.pins.push_back(local_pin(pin, share));
  return local;
}

}  // namespace aspic::distributed
