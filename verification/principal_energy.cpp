// The formulas of the materials in principal stretches, written down once more.
#include <cmath>
#include <stdexcept>

#include "verification/uniaxial.h"

namespace aspic::verify {
namespace {

using Real = long double;

Real square(Real x) { return x * x; }

struct Invariants {
  Real I1, I2, J, I1bar, I2bar;
  explicit Invariants(const std::array<Real, 3>& l)
      : I1(square(l[0]) + square(l[1]) + square(l[2])),
        I2(square(l[0] * l[1]) + square(l[1] * l[2]) + square(l[2] * l[0])),
        J(l[0] * l[1] * l[2]),
        I1bar(I1 / std::pow(J, 2 / Real(3))),
        I2bar(I2 / std::pow(J, 4 / Real(3))) {}
};

// The sums of e and of e^2.
std::array<Real, 2> sums(const std::array<Real, 3>& e) {
  return {e[0] + e[1] + e[2], square(e[0]) + square(e[1]) + square(e[2])};
}

}  // namespace

long double principal_energy(const std::string& material, const std::array<long double, 3>& l, double young,
                             double poisson) {
  const Real E = young, nu = poisson;
  const Real mu = E / (2 * (1 + nu)), la = E * nu / ((1 + nu) * (1 - 2 * nu)), K = la + 2 * mu / 3;
  const Invariants i(l);
  const auto [strain, strain2] = sums({l[0] - 1, l[1] - 1, l[2] - 1});
  const auto [green, green2] = sums({(square(l[0]) - 1) / 2, (square(l[1]) - 1) / 2, (square(l[2]) - 1) / 2});
  const Real volumetric = K / 2 * square(i.J - 1);
  if (material == "neo_hookean") return mu / 2 * (i.I1 - 3) - mu * (i.J - 1) + (la + mu) / 2 * square(i.J - 1);
  if (material == "stable_neo_hookean") {
    const Real m = 4 * mu / 3, a = la + 5 * mu / 6, alpha = 1 + 3 * m / (4 * a);
    return m / 2 * (i.I1 - 3) + a / 2 * square(i.J - alpha) - m / 2 * std::log(i.I1 + 1);
  }
  if (material == "neo_hookean_log") return mu / 2 * (i.I1 - 3) - mu * std::log(i.J) + la / 2 * square(std::log(i.J));
  if (material == "neo_hookean_log_j2") return mu / 2 * (i.I1 - 3) - mu * std::log(i.J) + la / 2 * square(i.J - 1);
  // Without growths, the spline is the isochoric law.
  if (material == "neo_hookean_isochoric" || material == "neo_hookean_2020" || material == "spline")
    return mu / 2 * (i.I1bar - 3) + volumetric;
  if (material == "mooney_rivlin") return mu / 4 * (i.I1bar - 3 + i.I2bar - 3) + volumetric;  // share = 1/2
  if (material == "fung") return mu / 2 * (std::exp(i.I1bar - 3) - 1) + volumetric;           // b = 1
  if (material == "stvk") return mu * green2 + la / 2 * square(green);
  if (material == "corotated") return mu * strain2 + la / 2 * square(i.J - 1);
  if (material == "arap") return mu * strain2;
  if (material == "linear") return mu * strain2 + la / 2 * square(strain);
  throw std::runtime_error("no reference for the material " + material + "; add it to principal_energy.cpp");
}

}  // namespace aspic::verify
