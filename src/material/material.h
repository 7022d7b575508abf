// What a hyperelastic material is: an energy density of the deformation gradient F and its two derivatives.
#pragma once
#include <concepts>

#include "math/pack.h"
#include "math/small.h"

namespace aspic {

template <class M, class T>
concept MaterialOver = requires(const Mat3<T> F, const typename M::template Params<T> p) {
  { M::psi(F, p) } -> std::same_as<T>;            // energy density         [J/m^3]
  { M::pk1(F, p) } -> std::same_as<Mat3<T>>;      // P = dpsi/dF            [Pa]
  { M::hessian(F, p) } -> std::same_as<Mat9<T>>;  // d vec(P) / d vec(F)    [Pa]
};

template <class M>
concept Material = MaterialOver<M, double> && MaterialOver<M, Pack>;

}  // namespace aspic
