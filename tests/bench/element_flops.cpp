#include "bench/element_flops.h"

#include "bench/counted.h"
#include "material/list.h"
#include "math/definite.h"

namespace aspic::bench {
namespace {

constexpr double kDot3 = 5;                                     // three products, two sums
constexpr double kDeformationGradient = 9 + 9 * kDot3;          // Ds: 9 differences; F = Ds Dm^-1
constexpr double kShapeGradients = 6;                           // the first is minus the sum of the others
constexpr double kGradientScatter = 1 + 12 * (kDot3 + 1) + 12;  // w P b_v of 4 vertices, added to g
// w A b_v of 3 vertices, and the first as a sum; six blocks b_u' A b_v, and those of the first vertex as sums; 10
// blocks are added.
constexpr double kHessianScatter = 1 + 3 * 27 * (kDot3 + 1) + 27 * 2 + 6 * 9 * kDot3 + 4 * 9 * 2 + 10 * 9;

template <class Fn>
double flops_of(const Fn& fn) {
  const double before = Counted::flops;
  fn();
  return Counted::flops - before;
}

Mat3<Counted> sheared() {  // close to rest, with three different stretches
  Mat3<Counted> F = identity3<Counted>();
  F(0, 0) = 1.1, F(1, 1) = 0.95, F(0, 1) = 0.02, F(2, 1) = 0.03;
  return F;
}

template <class M>
ElementFlops count() {
  const Mat3<Counted> F = sheared();
  MaterialParameters constants{.lame = lame_from_young_poisson(1e6, 0.4)};
  const MaterialInfo info = M::info();
  for (size_t k = 0; k < info.extra.size(); ++k) constants.extra[k] = info.extra[k].fallback;
  const auto p = broadcast_params<M, Counted>(M::params(constants));
  Mat9<Counted> H;
  ElementFlops flops;
  flops.value = kDeformationGradient + flops_of([&] { M::psi(F, p); }) + 2;
  flops.gradient = kDeformationGradient + kShapeGradients + flops_of([&] { M::pk1(F, p); }) + kGradientScatter;
  flops.hessian = kDeformationGradient + kShapeGradients + flops_of([&] { H = M::hessian(F, p); }) + kHessianScatter;
  flops.definite_test = flops_of([&] { indefinite_lanes(H); });
  return flops;
}

}  // namespace

ElementFlops element_flops(const std::string& material) {
  ElementFlops flops;
  with_material(material, [&]<class M>() { flops = count<M>(); });
  return flops;
}

}  // namespace aspic::bench
