#include "energy/tet_elasticity.h"

#include "energy/make_tet_term.h"
#include "material/list.h"

namespace aspic {

std::unique_ptr<TetElasticity> make_tet_elasticity(std::string_view material, const TetMesh& mesh, int first,
                                                   std::span<const MaterialParameters> parameters) {
  std::unique_ptr<TetElasticity> term;
  with_material(material, [&]<class M>() { term = make_tet_term<M>(mesh, first, parameters); });
  return term;
}

}  // namespace aspic
