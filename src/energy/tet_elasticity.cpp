#include "energy/tet_elasticity.h"

#include "energy/make_tet_term.h"
#include "energy/mean_volume.h"
#include "material/list.h"
#include "mesh/tet_nodes.h"

namespace aspic {

std::unique_ptr<TetElasticity> make_tet_elasticity(std::string_view material, const TetMesh& mesh, int first,
                                                   std::span<const MaterialParameters> parameters) {
  const ElasticityMaker maker = [material](const TetMesh& of, int begin, std::span<const MaterialParameters> values) {
    std::unique_ptr<TetElasticity> term;
    with_material(material, [&]<class M>() {
      const bool quadratic = !values.empty() && is_quadratic(of, begin);
      term = quadratic ? make_tet_term<M, QuadraticTetBatch>(of, begin, values)
                       : make_tet_term<M, TetBatch>(of, begin, values);
    });
    return term;
  };
  const bool ignores_lambda = material == "arap";
  if (ignores_lambda || parameters.empty() || !is_quadratic(mesh, first)) return maker(mesh, first, parameters);
  bool has_barrier = false;
  with_material(material, [&]<class M>() { has_barrier = M::info().barrier; });
  return make_mean_volume(maker, mesh, first, parameters, has_barrier);
}

}  // namespace aspic
