#include "bench/kernel_beam.h"

#include <cmath>
#include <utility>

#include "bench/beam_problem.h"
#include "bench/element_flops.h"
#include "dynamics/model_builder.h"
#include "material/list.h"

namespace aspic::bench {
namespace {

constexpr double kDouble = 8, kIndex = 4, kBlock = 9 * kDouble;  // [bytes]
constexpr double kWritten = 2;                                   // factor for written data, which is read first

// Bytes for the corners, Dm^-1, volume and material of each tet and the position of each vertex.
double element_bytes(const KernelBeam& beam) {
  return beam.tets() * (4 * kIndex + (10 + beam.parameters) * kDouble) + beam.vertices() * 3 * kDouble;
}

}  // namespace

KernelBeam::KernelBeam(int n, const std::string& material) : mesh(make_beam(n)) {
  with_material(material, [&]<class M>() { parameters = kParameterCount<M>; });
  Model model = ModelBuilder(mesh).material(material, {.young = kYoung, .poisson = kPoisson}).density(kDensity).build();
  elasticity = std::move(model.elasticity[0]);
  for (const Vec3d& X : mesh.rest) {
    x.insert(x.end(), {X[0] + 0.02 * std::sin(X[1]), X[1] - 0.01 * X[0] * X[0], X[2] + 0.03 * X[0] * X[1]});
  }
  Couplings couplings;
  elasticity->add_couplings(couplings);
  model.mass->add_couplings(couplings);
  pattern = make_pattern(mesh.vertex_count(), std::move(couplings));
  pattern.rest_position = mesh.rest;
  model.mass->bind(pattern);
  elasticity->bind(pattern);
  H = std::make_unique<BlockSparse>(pattern);
  H->set_zero();
  model.mass->add_to(1, *H);
  elasticity->add_hessian(x, kTimeStep * kTimeStep, {Definiteness::exact}, *H);
}

KernelBeam& kernel_beam(int n, const std::string& material) {
  static std::unique_ptr<KernelBeam> beam;
  static std::pair<int, std::string> made;
  if (!beam || made != std::pair(n, material)) {
    beam.reset();  // frees memory first: two large beams need not fit
    beam = std::make_unique<KernelBeam>(n, material);
    made = {n, material};
  }
  return *beam;
}

namespace kernel_work {

KernelWork value(const KernelBeam& beam, const std::string& material) {
  return {element_bytes(beam), beam.tets() * element_flops(material).value};
}

KernelWork gradient(const KernelBeam& beam, const std::string& material) {
  return {element_bytes(beam) + kWritten * beam.vertices() * 3 * kDouble,
          beam.tets() * element_flops(material).gradient};
}

KernelWork hessian(const KernelBeam& beam, const std::string& material, bool tested) {
  const ElementFlops flops = element_flops(material);
  const double slots = beam.tets() * 10 * kIndex;
  return {element_bytes(beam) + slots + kWritten * beam.blocks() * kBlock,
          beam.tets() * (flops.hessian + (tested ? flops.definite_test : 0))};
}

// Each off-diagonal block is read once and used twice.
KernelWork block_product(const KernelBeam& beam) {
  const double off_diagonal = beam.blocks() - beam.vertices();
  return {beam.blocks() * (kBlock + kIndex) + beam.vertices() * (kIndex + (1 + kWritten) * 3 * kDouble),
          18 * (beam.vertices() + 2 * off_diagonal)};
}

// One iteration: the product, p.q, x and r, z = D^-1 r with r.r and r.z, p. Reads D^-1, p, q, x, r, z; writes q, x, r,
// z, p.
KernelWork preconditioned_iteration(const KernelBeam& beam) {
  const KernelWork product = block_product(beam);
  const double vectors = 2 /* p.q */ + (4 + kWritten * 2 - 2) /* x, r */ + (1 + kWritten) /* z */ + (2 + kWritten - 1);
  return {product.bytes + beam.vertices() * (kBlock + vectors * 3 * kDouble),
          product.flops + beam.vertices() * (3 * (2 + 4 + 4 + 2) + 15)};
}

// Finest level only: blocks in single precision, off-diagonal blocks read twice (both triangles before and after the
// coarse levels), inverses of the diagonal blocks read twice.
KernelWork finest_cycle(const KernelBeam& beam) {
  const double off_diagonal = beam.blocks() - beam.vertices();
  const double vectors = 3 + 2 * kWritten + 2 + kWritten;  // x and r before; x after; b twice
  return {2 * 36 * (2 * off_diagonal + beam.vertices()) + vectors * 16 * beam.vertices(),
          2 * 18 * (2 * off_diagonal + beam.vertices())};
}

KernelWork dot(double size) { return {2 * size * kDouble, 2 * size}; }
KernelWork axpy(double size) { return {(1 + kWritten) * size * kDouble, 2 * size}; }

}  // namespace kernel_work
}  // namespace aspic::bench
