// The law of the barrier at the nodes of quadratic tets, see node_barrier.h.
#pragma once
#include "energy/material_term.h"
#include "energy/quadratic_batch.h"
#include "material/barrier.h"
#include "material/from_invariants.h"

namespace aspic {

struct NodeBarrierLaw {
  static constexpr double kStart = 0.1;  // J below which the barrier acts
  int extra = 0;                         // number of entries of MaterialParameters::extra

  template <class T>
  struct Params {
    T weight;  // [Pa]
  };
  template <class T>
  static Params<T> params(const MaterialParametersOver<T>& m) {
    return {T(kStart) * m.lame.mu};
  }

  static bool is_zero(const Mat3<Pack>& F) { return min(determinant(F)) >= kStart; }

  template <class T>
  static T energy(const T&, const T& J, const Params<T>& p) {
    const T t = T(1 / kStart) * J, d = t - T(1.0);
    return where_positive(-d, infinite_unless_positive(J, -p.weight * d * d * log(t)), T(0.0));
  }
  template <class T>
  static LawDerivativesLinearInI1<T> derivatives(const T&, const T& J, const Params<T>& p) {
    const T t = T(1 / kStart) * J, d = t - T(1.0), r = d / t, scale = T(-1 / kStart) * p.weight;
    const T slope = scale * (T(2.0) * d * log(t) + d * r);
    const T curvature = T(1 / kStart) * scale * (T(2.0) * log(t) + T(4.0) * r - r * r);
    return {T(0.0), where_positive(-d, slope, T(0.0)), where_positive(-d, curvature, T(0.0))};
  }
};

using NodeBarrier = MaterialTerm<FromInvariants<NodeBarrierLaw>, QuadraticNodeBatch>;

}  // namespace aspic
