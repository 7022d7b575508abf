// A CustomDensity as a material of MaterialTerm.
#pragma once
#include <memory>

#include "energy/custom_elasticity.h"

namespace aspic {

struct CustomMaterial {
  template <class T>
  using Params = MaterialParametersOver<T>;

  std::shared_ptr<const CustomDensity> density;
  int extra;  // number of used entries of MaterialParameters::extra

  template <class T>
  static Params<T> params(const Params<T>& p) {
    return p;
  }
  Pack psi(const Mat3<Pack>& F, const Params<Pack>& p) const { return density->psi(F, p); }
  template <class T>
  Mat3<T> pk1(const Mat3<T>& F, const Params<T>& p) const {
    return density->pk1(F, p);
  }
  Mat9<Pack> hessian(const Mat3<Pack>& F, const Params<Pack>& p) const { return density->hessian(F, p); }
};

}  // namespace aspic
