// Instantiated for each material and element in a generated file of its own (see src/CMakeLists.txt), so that changing
// a material recompiles two files, and kernels of linear tets do not depend on those of quadratic ones.
#pragma once
#include <memory>
#include <span>

#include "energy/tet_elasticity.h"

namespace aspic {

struct TetBatch;
struct QuadraticTetBatch;

template <class M, class Batch>
std::unique_ptr<TetElasticity> make_tet_term(const TetMesh& mesh, int first,
                                             std::span<const MaterialParameters> parameters);

}  // namespace aspic
