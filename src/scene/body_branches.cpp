#include "scene/body_branches.h"

#include <algorithm>

#include "base/error.h"
#include "base/formatted.h"
#include "base/free_memory.h"
#include "energy/maxwell_branches.h"
#include "scene/schema.h"
#include "scene/tables.h"

namespace aspic {
namespace {

struct BodyBranches {
  PlacedBody& body;
  Array& scenes;     // of [[body.viscoelastic]]
  std::string name;  // of the term
};

// Two copies of the stresses of each branch and, for all together, strains and coefficients, at each point.
double bytes_of(const BodyBranches& of) {
  const double points = of.body.mesh.mids.empty() ? 1 : 4;
  return sizeof(double) * points * of.body.mesh.tet_count() * (13.0 + 12.0 * static_cast<double>(of.scenes.size()));
}

void require_memory(const BodyBranches& of, std::int64_t memory) {
  const double bytes = bytes_of(of), available = static_cast<double>(std::min(memory, free_memory()));
  if (bytes > available)
    throw error_at(of.scenes[0].place,
                   formatted("%zu viscoelastic branches of %d tets need at least %.3g GB; %.3g GB of memory are free",
                             of.scenes.size(), of.body.mesh.tet_count(), bytes / 1e9, available / 1e9) +
                       " (choose fewer branches or a coarser mesh)");
}

// G of each tet of the user [Pa].
std::vector<double> shear_moduli(PlacedBody& body, Value& scene, const FieldScope& fields,
                                 const TetElasticity& elastic) {
  const char* key = scene.find("shear") ? "shear" : "ratio";
  std::vector<double> shear = element_values(scene.table(), scene_schema().key("viscoelastic", key), fields);
  if (scene.find("shear")) return shear;
  if (!body.scene["elastic"].boolean())
    throw error_at(
        scene["ratio"].place,
        "ratio: body '" + body.name() + "' has elastic = false, so its shear modulus " + "is 0; set `shear` instead");
  const std::vector<MaterialParameters> parameters = elastic.parameters();
  for (int t = 0; t < body.mesh.tet_count(); ++t) shear[t] *= parameters[body.numbering.tet.from_user(t)].lame.mu;
  return shear;
}

}  // namespace

void add_branches(std::vector<PlacedBody>& bodies, const BranchScope& scope, Model& model) {
  int number = 0;
  for (size_t i = 0; i < bodies.size(); ++i) {
    PlacedBody& body = bodies[i];
    Value* list = body.scene.table().find("viscoelastic");
    if (!list || list->array().empty()) continue;
    const BodyBranches of{body, list->array(), "viscoelastic" + (++number == 1 ? "" : "_" + std::to_string(number))};
    require_memory(of, scope.memory);
    std::vector<MaxwellBranch> branches;
    for (Value& scene : of.scenes) {
      const std::string stem = body.name() + "." + of.name + "." + std::to_string(branches.size() + 1);
      const FieldScope fields{body.mesh, scope.files, stem, *body.painted, nullptr, &body.groups};
      branches.push_back({body.numbering.tet.from_user(shear_moduli(body, scene, fields, *model.elasticity[i])),
                          scene["relaxation_time"].number()});
    }
    model.damping.push_back(make_maxwell_branches(of.name, model.mesh, body.first_tet, std::move(branches)));
  }
}

}  // namespace aspic
