// Type-erased materials, evaluated at one point.
#pragma once
#include <string>
#include <vector>

#include "material/reference.h"
#include "material/registry.h"
#include "material/states.h"
#include "math/jet.h"

namespace aspic::verify {

// A material with constants that differ from each other and from their defaults.
struct Law {
  MaterialInfo info;
  double (*psi)(const Mat3d& F);                  // energy density [J/m^3]
  Mat3d (*pk1)(const Mat3d& F);                   // as implemented by the library [Pa]
  Mat9d (*hessian)(const Mat3d& F);               //
  Jet<double> (*differentiated)(const Mat3d& F);  // psi and its derivatives by automatic differentiation of psi
  // Energy density from principal stretches by the documented formula of the material [J/m^3].
  long double (*reference)(const PrincipalStretches& s, const ReferenceModuli& m);
  std::vector<NamedState> states;  // states where psi is twice differentiable
};

const Law& law(const std::string& material);  // throws InvalidInput for an unknown one

}  // namespace aspic::verify
