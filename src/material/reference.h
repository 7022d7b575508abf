// Arguments of the reference energy densities, which define each material in principal stretches and extended
// precision. Verification compares the materials with them.
#pragma once
#include <array>
#include <cmath>

namespace aspic {

struct PrincipalStretches {
  using Real = long double;

  explicit PrincipalStretches(const std::array<Real, 3>& l)
      : I1(sum(l, [](Real x) { return x * x; })),
        I2(l[0] * l[0] * l[1] * l[1] + l[1] * l[1] * l[2] * l[2] + l[2] * l[2] * l[0] * l[0]),
        J(l[0] * l[1] * l[2]),
        I1bar(I1 / std::pow(J, 2 / Real(3))),
        I2bar(I2 / std::pow(J, 4 / Real(3))),
        strain(sum(l, [](Real x) { return x - 1; })),
        strain2(sum(l, [](Real x) { return (x - 1) * (x - 1); })),
        green(sum(l, [](Real x) { return (x * x - 1) / 2; })),
        green2(sum(l, [](Real x) { return (x * x - 1) * (x * x - 1) / 4; })) {}

  Real I1, I2, J, I1bar, I2bar;
  Real strain, strain2;  // sums of l - 1 and of (l - 1)^2
  Real green, green2;    // the same for the Green strain (l^2 - 1) / 2

 private:
  template <class Term>
  static Real sum(const std::array<Real, 3>& l, const Term& term) {
    return term(l[0]) + term(l[1]) + term(l[2]);
  }
};

struct ReferenceModuli {
  ReferenceModuli(long double E, long double nu)
      : mu(E / (2 * (1 + nu))), la(E * nu / ((1 + nu) * (1 - 2 * nu))), K(la + 2 * mu / 3) {}

  long double mu, la, K;  // small-strain constants [Pa]
};

}  // namespace aspic
