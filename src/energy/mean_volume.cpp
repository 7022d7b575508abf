#include "energy/mean_volume.h"

#include "energy/mean_volume_term.h"

namespace aspic {

std::unique_ptr<TetElasticity> make_mean_volume(const ElasticityMaker& make_shape, const TetMesh& mesh, int first,
                                                std::span<const MaterialParameters> parameters, bool has_barrier) {
  return std::make_unique<mean_volume::MeanVolume>(make_shape, mesh, first, parameters, has_barrier);
}

}  // namespace aspic
