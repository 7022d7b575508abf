// Ogden solid with two terms and any exponents: psi = sum over p of 2 mu_p/alpha_p^2 (sum over i of x_i - 3) + K/2 (J -
// 1)^2, x_i = (s_i / J^(1/3))^alpha_p, for the principal stretches s; +inf for J <= 0. alpha = 0 is the limit: Hencky.
#pragma once
#include <concepts>

#include "material/isochoric.h"
#include "material/material.h"
#include "material/reference.h"
#include "material/registry.h"
#include "material/stretch_hessian.h"
#include "math/matrix_functions.h"

namespace aspic {

struct Ogden {
  template <class T>
  struct Params {
    T mu[2], alpha[2];  // shear moduli [Pa], exponents [1]
    T bulk;             // [Pa]
  };

  template <class T>
  static T psi(const Mat3<T>& F, const Params<T>& p) {
    const T J = determinant(F);
    T W(0.0);
    if constexpr (kHasSvd<T>) {
      const Vec3<T> e = log_strains(svd3(F).s);
      for (int k = 0; k < 2; ++k)
        for (int i = 0; i < 3; ++i) W = W + T(2.0) * p.mu[k] * e[i] * e[i] * remainder(p.alpha[k] * e[i]);
    } else {
      const Mat3<T> E = log_strain(F, J);
      for (int k = 0; k < 2; ++k) W = W + T(2.0) * p.mu[k] * trace(exp_remainders(p.alpha[k], E).second);
    }
    return isochoric_energy(J, W, p.bulk);
  }

  template <class T>
  static Mat3<T> pk1(const Mat3<T>& F, const Params<T>& p) {
    if constexpr (kHasSvd<T>) {
      const Svd3<T> f = svd3(F);
      return stress_of_stretches(f, derivatives(f.s, p).first);
    } else {
      const T J = determinant(F);
      const Mat3<T> E = log_strain(F, J), I = identity3<T>();
      Mat3<T> tau = p.bulk * (J - T(1.0)) * J * I;  // Kirchhoff stress, rotated to the axes of F'F
      for (int k = 0; k < 2; ++k) {
        const Mat3<T> X = exp_remainders(p.alpha[k], E).first;
        tau = tau + T(2.0) * p.mu[k] * (X - T(1.0 / 3.0) * trace(X) * I);
      }
      return transpose(inverse(F)) * tau;
    }
  }

  template <class T>
  static Mat9<T> hessian(const Mat3<T>& F, const Params<T>& p) {
    const Svd3<T> f = svd3(F);
    return hessian_of_stretches(f, derivatives(f.s, p));
  }

  template <class T>
  static Params<T> params(const MaterialParametersOver<T>& m) {
    const T& share = m.extra[2];
    return {{m.lame.mu * (T(1.0) - share), m.lame.mu * share}, {m.extra[0], m.extra[1]}, bulk_modulus(m.lame)};
  }

  static long double reference_energy(const PrincipalStretches& s, const ReferenceModuli& m) {
    return m.mu / 2 * (s.I1bar - 3) + m.K / 2 * (s.J - 1) * (s.J - 1);  // alpha = 2, share_2 = 0
  }

  static MaterialInfo info() {
    return {
        .name = "ogden",
        .formula =
            "sum over p of 2 mu_p/alpha_p^2 (sum over i of (s_i J^(-1/3))^alpha_p - 3) + K/2 (J - 1)^2 with "
            "mu_1 = (1 - share_2) mu_L, mu_2 = share_2 mu_L, K = la_L + 2/3 mu_L, s_i the principal stretches",
        .tex = {R"tex(\psi = \sum_p \tfrac{2\mu_p}{\alpha_p^2} \Bigl(\sum_i \bar s_i^{\,\alpha_p} - 3\Bigr)
                          + \tfrac{K}{2} (J - 1)^2)tex",
                R"tex(\mu_1 = (1 - \mathrm{share}_2)\, \mu, \quad \mu_2 = \mathrm{share}_2\; \mu)tex",
                R"tex(\bar s_i = J^{-1/3} s_i, \quad K = \lambda + \tfrac23 \mu)tex",
                R"tex(\psi = \infty \quad (J \le 0))tex"},
        .remarks =
            "+inf for J <= 0 and where a power overflows. A negative alpha stiffens in compression, as brain does. "
            "In the form sum mu_p/alpha_p (...) of other programs, mu_p is 2 mu_p/alpha_p here. The only state "
            "without stress is the rest shape, up to rotation. [Ogden 1972]",
        .extra =
            {{.name = "alpha", .unit = "1", .meaning = "exponent", .fallback = 2, .min = -100, .max = 100},
             {.name = "alpha_2",
              .unit = "1",
              .meaning = "exponent of the second term",
              .fallback = -2,
              .min = -100,
              .max = 100},
             {.name = "share_2", .unit = "1", .meaning = "share of mu_2 in mu_L", .fallback = 0, .min = 0, .max = 1}},
        .barrier = true};
  }

 private:
  template <class T>
  static constexpr bool kHasSvd = std::same_as<T, double> || std::same_as<T, Pack>;

  // Returns ln U, U = (F'F)^(1/2) J^(-1/3).
  template <class T>
  static Mat3<T> log_strain(const Mat3<T>& F, const T& J) {
    return T(0.5) * matrix_log(isochoric_scale(J) * (transpose(F) * F));
  }
  // Returns ln(s_i J^(-1/3)).
  template <class T>
  static Vec3<T> log_strains(const Vec3<T>& s) {
    const Vec3<T> l = {{log(s[0]), log(s[1]), log(s[2])}};
    const T mean = T(1.0 / 3.0) * (l[0] + l[1] + l[2]);
    return {{l[0] - mean, l[1] - mean, l[2] - mean}};
  }
  // (e^y - 1 - y) / y^2
  template <class T>
  static T remainder(const T& y) {
    T series = T(1.0);
    for (int k = 13; k > 2; --k) series = T(1.0) + T(1.0 / k) * y * series;
    return where_positive(y * y - T(0.09), (exp(y) - T(1.0) - y) / (y * y), T(0.5) * series);
  }
  // sinh(y) / y
  template <class T>
  static T sinhc(const T& y) {
    const T yy = y * y, e = exp(y);
    T series = T(1.0);
    for (int k = 12; k > 0; k -= 2) series = T(1.0) + T(1.0 / (k * (k + 1))) * yy * series;
    return where_positive(yy - T(0.25), T(0.5) * (e - T(1.0) / e) / y, series);
  }

  // In logarithms l_i = ln s_i: tau_i = dpsi/dl_i = sum 2 mu/alpha (x_i - mean x) + K J (J - 1) and dtau_i/dl_j = sum 2
  // mu (delta_ij x_i - (x_i + x_j)/3 + sum x/9) + K J (2J - 1). Differences of equal x cancel, so with u = l_i - l_j:
  //   (x_i - x_j) / alpha = sqrt(x_i x_j) u sinhc(alpha u/2),  s_i - s_j = sqrt(s_i s_j) u sinhc(u/2)
  template <class T>
  static StretchDerivatives<T> derivatives(const Vec3<T>& s, const Params<T>& p) {
    const Vec3<T> e = log_strains(s);
    const T J = s[0] * s[1] * s[2], r = T(1.0) / J, third = T(1.0 / 3.0);
    const T pressure = p.bulk * (J - T(1.0)) * J, stiffness = p.bulk * J * (J + J - T(1.0));
    Vec3<T> tau = {{pressure, pressure, pressure}}, slope = {{T(0.0), T(0.0), T(0.0)}};  // slope: (tau_i - tau_j) / u
    std::array<T, 9> dtau;
    for (T& x : dtau) x = stiffness;
    for (int k = 0; k < 2; ++k) {
      const T mu = p.mu[k] + p.mu[k];
      const Vec3<T> y = {
          {exp(T(0.5) * p.alpha[k] * e[0]), exp(T(0.5) * p.alpha[k] * e[1]), exp(T(0.5) * p.alpha[k] * e[2])}};
      const Vec3<T> x = {{y[0] * y[0], y[1] * y[1], y[2] * y[2]}};
      const T mean = third * (x[0] + x[1] + x[2]);
      for (int a = 0; a < 3; ++a) {
        const int i = (a + 1) % 3, j = (a + 2) % 3;
        const T u = e[i] - e[j], d = mu / y[a] * sinhc(T(0.5) * p.alpha[k] * u);  // sqrt(x_i x_j) = 1 / y_a
        slope[a] = slope[a] + d;
        tau[i] = tau[i] + third * d * u;
        tau[j] = tau[j] - third * d * u;
        for (int b = 0; b < 3; ++b)
          dtau[a + 3 * b] = dtau[a + 3 * b] + mu * ((a == b ? x[a] : T(0.0)) + third * (mean - x[a] - x[b]));
      }
    }
    StretchDerivatives<T> result;
    for (int a = 0; a < 3; ++a) {
      const int i = (a + 1) % 3, j = (a + 2) % 3;
      const T root = sqrt(s[i] * s[j]), change = slope[a] / (root * sinhc(T(0.5) * (e[i] - e[j])));
      result.first[a] = tau[a] / s[a];
      result.difference[a] = (change * s[j] - tau[j]) * (s[a] * r);
      for (int b = 0; b < 3; ++b)
        result.second[a + 3 * b] = (dtau[a + 3 * b] - (a == b ? tau[a] : T(0.0))) / (s[a] * s[b]);
    }
    return result;
  }
};

}  // namespace aspic
