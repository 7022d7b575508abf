// What the kernels run on: the beam bent and sheared a little, one material, and the Hessian of a time step. And what
// each kernel moves and computes at least.
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
  double blocks() const { return static_cast<double>(pattern.block_count()); }  // of the lower triangle

  TetMesh mesh;
  std::vector<double> x;  // 3 per vertex [m]
  std::unique_ptr<TetElasticity> elasticity;
  BlockPattern pattern;
  std::unique_ptr<BlockSparse> H;
  double parameters = 0;  // of the material, per tet
};

// The beam of the last call again where nothing changed: it takes seconds to make.
KernelBeam& kernel_beam(int n, const std::string& material);

// Bytes: what must come from memory once, and what is written twice over, since its lines are read first. Indices are
// 4 bytes. A kernel whose data stays in a cache may exceed what memory alone would allow.
namespace kernel_work {

KernelWork value(const KernelBeam& beam, const std::string& material);
KernelWork gradient(const KernelBeam& beam, const std::string& material);
KernelWork hessian(const KernelBeam& beam, const std::string& material, bool tested);
KernelWork block_product(const KernelBeam& beam);
KernelWork preconditioned_iteration(const KernelBeam& beam);  // of conjugate gradients with 3x3 diagonal blocks
KernelWork finest_cycle(const KernelBeam& beam);              // of multigrid
KernelWork dot(double size);
KernelWork axpy(double size);

}  // namespace kernel_work

}  // namespace aspic::bench
