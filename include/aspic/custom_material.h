// Materials of your own as a function of F, written once for any scalar T; derivatives are automatic:
//   struct MyEnergy {
//     template <class T> struct Params { T mu; };  // [Pa]
//     template <class T> static T psi(const Mat3<T>& F, const Params<T>& p) { return ...; }  // [J/m^3]
//     template <class T> static Params<T> params(const MaterialParametersOver<T>& m) { return {m.lame.mu}; }
//   };
//   builder.material(custom_material<FromEnergy<MyEnergy>>("mine"), parameters);
// T is a SIMD pack of doubles or a jet of derivatives over one, so psi has no branches: use where_positive(). This
// header is not part of aspic.h. Compile with the flags of the library: they decide the width of a pack.
#pragma once
#include "energy/custom_elasticity.h"
#include "material/barrier.h"
#include "material/from_energy.h"
#include "material/material.h"
#include "math/dual.h"
#include "math/jet.h"
#include "math/pack.h"
