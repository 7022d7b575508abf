#include "verify/sphere_reference.h"

#include <cmath>

#include "verify/uniaxial.h"

namespace aspic::verify {
namespace {

using Real = long double;

class Shell {
 public:
  Shell(const std::string& material, double poisson) : material_(material), poisson_(poisson) {}

  Real psi(Real radial, Real hoop) const { return principal_energy(material_, {radial, hoop, hoop}, 1, poisson_); }
  // dpsi/d(radial), and half of dpsi/d(hoop): the stress of one of two directions.
  Real radial_stress(Real s, Real t) const { return (psi(s + h_, t) - psi(s - h_, t)) / (2 * h_); }
  Real hoop_stress(Real s, Real t) const { return (psi(s, t + h_) - psi(s, t - h_)) / (4 * h_); }
  // r'' from dP_r/dR + 2 (P_r - P_t) / R = 0.
  Real second_derivative(Real R, Real r, Real s) const {
    const Real t = r / R, by_s = (psi(s + h_, t) - 2 * psi(s, t) + psi(s - h_, t)) / (h_ * h_);
    const Real by_t = (radial_stress(s, t + h_) - radial_stress(s, t - h_)) / (2 * h_);
    return (2 * (hoop_stress(s, t) - radial_stress(s, t)) - by_t * (s - t)) / (R * by_s);
  }

  struct End {
    Real r, stress;
  };
  // From r(a) = inner, r'(a) = slope to b.
  End march(Real a, Real b, Real inner, Real slope) const {
    constexpr int kSteps = 100;
    const Real d = (b - a) / kSteps;
    Real r = inner, s = slope;
    for (int i = 0; i < kSteps; ++i) {
      const Real R = a + d * i;
      const Real s1 = s, c1 = second_derivative(R, r, s);
      const Real s2 = s + d / 2 * c1, c2 = second_derivative(R + d / 2, r + d / 2 * s1, s2);
      const Real s3 = s + d / 2 * c2, c3 = second_derivative(R + d / 2, r + d / 2 * s2, s3);
      const Real s4 = s + d * c3, c4 = second_derivative(R + d, r + d * s3, s4);
      r += d / 6 * (s1 + 2 * s2 + 2 * s3 + s4);
      s += d / 6 * (c1 + 2 * c2 + 2 * c3 + c4);
    }
    return {r, radial_stress(s, r / b)};
  }

 private:
  std::string material_;
  double poisson_;
  Real h_ = 1e-5L;
};

}  // namespace

Inflation inflated_sphere(const std::string& material, double poisson, double a, double b, double inner) {
  const Shell shell(material, poisson);
  // The slope at which no stress is left outside, by the secant method; without change of volume it is (a / inner)^2.
  Real before = 1, slope = (a / inner) * (a / inner);
  Real f_before = shell.march(a, b, inner, before).stress;
  for (int i = 0; i < 50 && std::abs(slope - before) > 1e-12L; ++i) {
    const Real f = shell.march(a, b, inner, slope).stress;
    const Real next = slope - f * (slope - before) / (f - f_before);
    before = slope, f_before = f, slope = next;
  }
  return {static_cast<double>(shell.march(a, b, inner, slope).r),
          -static_cast<double>(shell.radial_stress(slope, inner / a))};
}

}  // namespace aspic::verify
