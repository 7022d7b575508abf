// Instantiated for each material in its own generated file (see src/CMakeLists.txt), so that changing a material
// recompiles one file.
#pragma once
#include <memory>
#include <span>

#include "energy/tet_elasticity.h"

namespace aspic {

template <class M>
std::unique_ptr<TetElasticity> make_tet_term(const TetMesh& mesh, int first,
                                             std::span<const MaterialParameters> parameters);

}  // namespace aspic
