// Elastic energies of user-defined materials that are not compiled into the library.
#pragma once
#include <memory>
#include <string>
#include <utility>

#include "energy/tet_elasticity.h"
#include "material/material.h"
#include "math/dual.h"

namespace aspic {

// Interface of a material that evaluates kPackWidth tets per call. custom_material() implements it for a type.
class CustomDensity {
 public:
  template <class T>
  using Parameters = MaterialParametersOver<T>;

  virtual ~CustomDensity() = default;
  virtual Pack psi(const Mat3<Pack>& F, const Parameters<Pack>& p) const = 0;            // energy density [J/m^3]
  virtual Mat3<Pack> pk1(const Mat3<Pack>& F, const Parameters<Pack>& p) const = 0;      // P = dpsi/dF [Pa]
  virtual Mat9<Pack> hessian(const Mat3<Pack>& F, const Parameters<Pack>& p) const = 0;  // dvec(P)/dvec(F) [Pa]
  // P with its first and second derivatives along directions of F and p, for fits.
  virtual Mat3<Dual<Pack>> pk1(const Mat3<Dual<Pack>>& F, const Parameters<Dual<Pack>>& p) const = 0;
  virtual Mat3<Dual<Dual<Pack>>> pk1(const Mat3<Dual<Dual<Pack>>>& F, const Parameters<Dual<Dual<Pack>>>& p) const = 0;
};

template <class M>
class CustomDensityOf final : public CustomDensity {
 public:
  Pack psi(const Mat3<Pack>& F, const Parameters<Pack>& p) const override { return M::psi(F, M::params(p)); }
  Mat3<Pack> pk1(const Mat3<Pack>& F, const Parameters<Pack>& p) const override { return M::pk1(F, M::params(p)); }
  Mat9<Pack> hessian(const Mat3<Pack>& F, const Parameters<Pack>& p) const override {
    return M::hessian(F, M::params(p));
  }
  Mat3<Dual<Pack>> pk1(const Mat3<Dual<Pack>>& F, const Parameters<Dual<Pack>>& p) const override {
    return M::pk1(F, M::params(p));
  }
  Mat3<Dual<Dual<Pack>>> pk1(const Mat3<Dual<Dual<Pack>>>& F, const Parameters<Dual<Dual<Pack>>>& p) const override {
    return M::pk1(F, M::params(p));
  }
};

// Returns a factory of elastic energies. `name`: name of the term of V. `extra`: number of entries of
// MaterialParameters::extra that the material uses.
ElasticityMaker custom_material(std::string name, int extra, std::shared_ptr<const CustomDensity> density);

// The material M has the static functions psi, pk1 and hessian, see MaterialOver, and params(), which computes its own
// parameters from the MaterialParametersOver of a tet. FromEnergy makes M from psi and params() alone.
template <class M>
ElasticityMaker custom_material(std::string name, int extra = 0) {
  return custom_material(std::move(name), extra, std::make_shared<CustomDensityOf<M>>());
}

}  // namespace aspic
