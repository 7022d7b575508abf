// A material defined by its energy density alone: stress and Hessian by automatic differentiation.
//   struct MyEnergy {
//     template <class T> struct Params { T mu; };
//     template <class T> static T psi(const Mat3<T>& F, const Params<T>& p) { return ...; }
//   };
//   using MyMaterial = FromEnergy<MyEnergy>;
// The Hessian is exact up to round-off, and several times slower than a hand-written one.
#pragma once
#include "material/material.h"
#include "math/jet.h"

namespace aspic {

template <class Psi>
struct FromEnergy : Psi {
  template <class T>
  using Params = typename Psi::template Params<T>;

  template <class T>
  static Mat3<T> pk1(const Mat3<T>& F, const Params<T>& p) {
    return gradient(expanded(F, p));
  }
  template <class T>
  static Mat9<T> hessian(const Mat3<T>& F, const Params<T>& p) {
    return aspic::hessian(expanded(F, p));
  }

 private:
  template <class T>
  static Jet<T> expanded(const Mat3<T>& F, const Params<T>& p) {
    return Psi::psi(jet_variables(F), broadcast_params<Psi, Jet<T>, T>(p));
  }
};

}  // namespace aspic
