// Input of the kernels: the beam, slightly bent and sheared, with one material, and the Hessian of a time step. Also
// lower bounds of data and flops per kernel.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "bench/roofline.h"
#include "energy/tet_elasticity.h"
#include "linalg/block_sparse.h"
#include "mesh/tet_mesh.h"

namespace aspic::bench {

struct KernelBeam {
  KernelBeam(int n, const std::string& material);

  double tets() const { return mesh.tet_count(); }
  double vertices() const { return mesh.vertex_count(); }
  double blocks() const { return static_cast<double>(pattern.block_count()); }  // blocks of the lower triangle

  TetMesh mesh;
  std::vector<double> x;  // positions, 3 per vertex [m]
  std::unique_ptr<TetElasticity> elasticity;
  BlockPattern pattern;
  std::unique_ptr<BlockSparse> H;
  double parameters = 0;  // parameters of the material per tet
};

// Returns the beam of the last call if the arguments are equal, because building it takes seconds.
KernelBeam& kernel_beam(int n, const std::string& material);

// Bytes of memory traffic: each datum is read once; written data counts twice because its cache lines are read first.
// Indices have 4 bytes. Kernels whose data stays in a cache may exceed the bound of the memory.
namespace kernel_work {

KernelWork value(const KernelBeam& beam, const std::string& material);
KernelWork gradient(const KernelBeam& beam, const std::string& material);
KernelWork hessian(const KernelBeam& beam, const std::string& material, bool tested);
KernelWork block_product(const KernelBeam& beam);
KernelWork preconditioned_iteration(
    const KernelBeam& beam);                      // one iteration of conjugate gradients with 3x3 diagonal blocks
KernelWork finest_cycle(const KernelBeam& beam);  // one multigrid cycle on the finest level
KernelWork dot(double size);
KernelWork axpy(double size);

}  // namespace kernel_work

}  // namespace aspic::bench
