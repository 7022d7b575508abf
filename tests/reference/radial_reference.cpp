#include "reference/radial_reference.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>

#include "reference/uniaxial.h"

namespace aspic::verify {
namespace {

using Real = long double;
constexpr Real kH = 1e-5L;   // step of differences
constexpr int kSteps = 400;  // even number of Runge-Kutta steps

// Minimizes the integral of R^m W(R, r, r') over R from a to b.
class Radial {
 public:
  using Density = std::function<Real(Real R, Real r, Real s)>;  // s = r'
  Radial(int m, Real a, Real b, Density W) : m_(m), a_(a), b_(b), W_(std::move(W)) {}

  struct Point {
    Real R, r, s;
  };
  // Euler's equation from r(a) = r, r'(a) = s.
  std::vector<Point> path(Real r, Real s) const {
    const Real d = (b_ - a_) / kSteps;
    std::vector<Point> points = {{a_, r, s}};
    for (int i = 0; i < kSteps; ++i) {
      const Real R = a_ + d * i;
      const Real s1 = s, c1 = curvature({R, r, s});
      const Real s2 = s + d / 2 * c1, c2 = curvature({R + d / 2, r + d / 2 * s1, s2});
      const Real s3 = s + d / 2 * c2, c3 = curvature({R + d / 2, r + d / 2 * s2, s3});
      const Real s4 = s + d * c3, c4 = curvature({R + d, r + d * s3, s4});
      r += d / 6 * (s1 + 2 * s2 + 2 * s3 + s4);
      s += d / 6 * (c1 + 2 * c2 + 2 * c3 + c4);
      points.push_back({R + d, r, s});
    }
    return points;
  }
  Real stress(const Point& p) const { return (W_(p.R, p.r, p.s + kH) - W_(p.R, p.r, p.s - kH)) / (2 * kH); }

  // Returns the path from start(slope) with a stress-free end, by the secant method from two slopes.
  std::vector<Point> with_free_end(const std::function<std::vector<Point>(Real slope)>& start, Real before,
                                   Real slope) const {
    Real f_before = stress(start(before).back());
    for (int i = 0; i < 50; ++i) {
      if (std::abs(slope - before) <= 1e-12L) return start(slope);
      const Real f = stress(start(slope).back());
      if (!std::isfinite(f)) break;
      const Real next = slope - f * (slope - before) / (f - f_before);
      before = slope, f_before = f, slope = next;
    }
    throw std::runtime_error("the reference of a body of one radius did not converge");
  }

 private:
  // r'' from d/dR (R^m dW/ds) = R^m dW/dr.
  Real curvature(const Point& p) const {
    const auto [R, r, s] = p;
    const Real W_r = (W_(R, r + kH, s) - W_(R, r - kH, s)) / (2 * kH);
    const Real W_ss = (W_(R, r, s + kH) - 2 * W_(R, r, s) + W_(R, r, s - kH)) / (kH * kH);
    // d(dW/ds)/dR along the path without the r'' term.
    const Real ahead = stress({R + kH, r + kH * s, s}), behind = stress({R - kH, r - kH * s, s});
    return (W_r - m_ / R * stress(p) - (ahead - behind) / (2 * kH)) / W_ss;
  }

  int m_;
  Real a_, b_;
  Density W_;
};

// psi of a cylinder of unit radius; the axial stretch varies only for differentiation.
Real twisted_density(const std::string& material, double poisson, Real twist, Real length, const Radial::Point& p) {
  // Across the radius F is [r / R, twist r; 0, length], which gives product and sum of squares of its stretches.
  const Real hoop = p.r / p.R, shear = twist * p.r;
  const Real product = hoop * length, squares = hoop * hoop + shear * shear + length * length;
  const Real sum = std::sqrt(squares + 2 * product), gap = std::sqrt(std::max(squares - 2 * product, Real(0)));
  return principal_energy(material, {p.s, (sum + gap) / 2, (sum - gap) / 2}, 1, poisson);
}

}  // namespace

Inflation inflated_sphere(const std::string& material, double poisson, double a, double b, double inner) {
  const Radial shell(2, a, b, [&](Real R, Real r, Real s) {
    return principal_energy(material, {s, r / R, r / R}, 1, poisson);
  });
  // Incompressible estimate: the inner slope is (a / inner)^2.
  const Real guess = (a / inner) * (a / inner);
  const auto path = shell.with_free_end([&](Real slope) { return shell.path(inner, slope); }, 1, guess);
  return {static_cast<double>(path.back().r), -static_cast<double>(shell.stress(path.front()))};
}

double Torsion::radius(double R) const {
  size_t i = 1;
  while (i + 1 < radii.size() && radii[i][0] < R) ++i;
  const auto& [R0, r0] = radii[i - 1];
  const auto& [R1, r1] = radii[i];
  return r0 + (r1 - r0) * (R - R0) / (R1 - R0);
}

Torsion twisted_cylinder(const std::string& material, double poisson, double twist) {
  const auto density = [&](Real t, Real length) {
    return [&material, poisson, t, length](Real R, Real r, Real s) {
      return twisted_density(material, poisson, t, length, {R, r, s});
    };
  };
  // Near the axis r = slope R. The neglected terms are of order a^2 and are absorbed by the unknown slope.
  const Real a = 0.01L;
  const Radial cylinder(1, a, 1, density(twist, 1));
  const auto path = cylinder.with_free_end([&](Real slope) { return cylinder.path(slope * a, slope); }, 1, 0.98L);
  // Simpson's rule. The core within a contributes 1e-8 of the torque; its axial stress equals that at a.
  const auto integral = [&](const Radial::Density& f) {
    Real sum = 0;
    for (int i = 0; i <= kSteps; ++i) {
      const auto& [R, r, s] = path[i];
      sum += (i == 0 || i == kSteps ? 1 : i % 2 == 1 ? 4 : 2) * R * f(R, r, s);
    }
    const auto& [R, r, s] = path[0];
    return static_cast<double>(2 * std::numbers::pi_v<Real> * (sum * (1 - a) / (3 * kSteps) + a * a / 2 * f(R, r, s)));
  };
  const auto slope_of = [](const Radial::Density& up, const Radial::Density& down) {
    return [=](Real R, Real r, Real s) { return (up(R, r, s) - down(R, r, s)) / (2 * kH); };
  };
  Torsion torsion{integral(slope_of(density(twist + kH, 1), density(twist - kH, 1))),
                  integral(slope_of(density(twist, 1 + kH), density(twist, 1 - kH))),
                  {{0, 0}}};
  for (const auto& [R, r, s] : path) torsion.radii.push_back({static_cast<double>(R), static_cast<double>(r)});
  return torsion;
}

}  // namespace aspic::verify
