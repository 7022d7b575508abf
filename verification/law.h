// The materials at one point, behind one face.
#pragma once
#include <string>
#include <vector>

#include "material/reference.h"
#include "material/registry.h"
#include "material/states.h"
#include "math/jet.h"

namespace aspic::verify {

// With constants that differ from each other and from their defaults.
struct Law {
  MaterialInfo info;
  double (*psi)(const Mat3d& F);                  // energy density [J/m^3]
  Mat3d (*pk1)(const Mat3d& F);                   // as the library computes them [Pa]
  Mat9d (*hessian)(const Mat3d& F);               //
  Jet<double> (*differentiated)(const Mat3d& F);  // psi and its derivatives, automatically from the source of psi
  // Energy density from principal stretches, by the formula of the material's documentation [J/m^3].
  long double (*reference)(const PrincipalStretches& s, const ReferenceModuli& m);
  std::vector<NamedState> states;  // where psi has two derivatives
};

const Law& law(const std::string& material);  // throws InvalidInput for an unknown one

}  // namespace aspic::verify
