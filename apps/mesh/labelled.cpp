#include "labelled.h"

namespace aspic {

TetMesh mesh_labelled(const LabelledDomain& domain, const LabelGrid& grid, double size, const MesherOptions& options) {
  SeededDomain<LabelledDomain> seeded(domain);
  seeded.set_seeds(grid.seeds());
  return filled(seeded, size, options);
}

}  // namespace aspic
