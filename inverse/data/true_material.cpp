#include "base/error.h"
#include "data/synthesis.h"
#include "scene/toml_reader.h"

namespace aspic {

FittedMaterial true_material(const Scene& scene) {
  const Model& model = scene.simulation.model();
  if (model.bodies.size() != 1)
    throw InvalidInput(scene.name + ": has " + std::to_string(model.bodies.size()) +
                       " bodies; the bench measures one: remove the others");
  const Value body = read_toml(scene.resolved, scene.name).find("body")->array().front();
  if (!body["elastic"].boolean())
    throw InvalidInput(scene.name + ": the body is not elastic; there is no material to measure");
  FittedMaterial truth;
  truth.model = body["material"]["model"].text();
  truth.mesh = to_user(model.numbering, model.mesh);
  const MaterialInfo& info = material_info(truth.model);
  std::vector<double> young, poisson;
  std::vector<std::vector<double>> extra(info.extra.size());
  for (const MaterialParameters& p : model.elasticity.front()->parameters()) {
    young.push_back(young_modulus(p.lame));
    poisson.push_back(poisson_ratio(p.lame));
    for (size_t e = 0; e < extra.size(); ++e) extra[e].push_back(p.extra[e]);
  }
  const Renumbering& tet = model.numbering.tet;
  truth.values = {{"young", tet.to_user(young)}, {"poisson", tet.to_user(poisson)}};
  for (size_t e = 0; e < extra.size(); ++e) truth.values.emplace_back(info.extra[e].name, tet.to_user(extra[e]));
  truth.values.emplace_back("density", tet.to_user(model.density));
  return truth;
}

}  // namespace aspic
