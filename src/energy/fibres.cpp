#include "energy/fibres.h"

#include "energy/tet_term.h"
#include "material/fibre_law.h"

namespace aspic {

std::unique_ptr<Energy> make_fibres(std::string name, const TetMesh& mesh, int first, std::span<const Fibre> fibres) {
  std::vector<FibreLaw::Params<double>> parameters;
  parameters.reserve(fibres.size());
  for (const auto& [a, k1, k2, kappa] : fibres) parameters.push_back({k1, k2, kappa, a[0], a[1], a[2]});
  return std::make_unique<TetTerm<FibreLaw, Energy>>(std::move(name), mesh, first, parameters);
}

}  // namespace aspic
