// Deformation gradients and constants for material tests.
#pragma once
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "material/list.h"
#include "math/small.h"

namespace aspic {

struct NamedState {
  std::string name;
  Mat3d F;
};

inline Mat3d diagonal(double x, double y, double z) { return {{x, 0, 0, 0, y, 0, 0, 0, z}}; }

inline Mat3d random_matrix(std::mt19937& random) {
  std::uniform_real_distribution<double> entry(-1, 1);
  Mat3d A;
  for (double& a : A.a) a = entry(random);
  return A;
}

// Rotation from a random unit quaternion.
inline Mat3d random_rotation(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const double a = normal(random), b = normal(random), c = normal(random), d = normal(random);
  const double s = 2 / (a * a + b * b + c * c + d * d);
  return {{1 - s * (c * c + d * d), s * (b * c + a * d), s * (b * d - a * c),  //
           s * (b * c - a * d), 1 - s * (b * b + d * d), s * (c * d + a * b),  //
           s * (b * d + a * c), s * (c * d - a * b), 1 - s * (b * b + c * c)}};
}

// Returns a deformation with J > 0: a rotation times a stretch of at most 60 %.
inline Mat3d random_deformation(std::mt19937& random) {
  return random_rotation(random) * (identity3<double>() + 0.2 * random_matrix(random));
}

// Typical constants with unequal extra parameters.
template <class M>
typename M::template Params<double> ordinary_params(double young = 2.5, double poisson = 0.4) {
  MaterialParameters m{lame_from_young_poisson(young, poisson), {}};
  const auto extra = M::info().extra;
  for (std::size_t k = 0; k < extra.size(); ++k)
    m.extra[k] = extra[k].fallback == 0 ? 0.1 * static_cast<double>(k + 1) : 0.7 * extra[k].fallback;
  return M::params(m);
}

// Whether fibres straighten near F: psi is smooth there, but only over strains of FibreLaw::kEps.
template <class M>
bool straightens_fibres(const Mat3d& F) {
  if constexpr (std::is_same_v<M, NeoHookeanFibres>) {
    const auto p = ordinary_params<M>();
    return std::abs(squared_norm(F * Vec3d{{p.ax, p.ay, p.az}}) - 1) < 5 * FibreLaw::kEps;
  }
  return false;
}

// States at which psi is finite and twice differentiable: J > 0 for barriers, and R differentiable if it is used. The
// part of a name before a comma is its kind.
template <class M>
std::vector<NamedState> smooth_states() {
  std::mt19937 random(7);
  const Mat3d I = identity3<double>();
  std::vector<NamedState> states = {{"F = I", I}, {"F = I, rotated", random_rotation(random)}};
  for (int i = 0; i < 20; ++i) {
    const Mat3d F = random_deformation(random);
    if (!straightens_fibres<M>(F)) states.push_back({"random, " + std::to_string(i), F});
  }
  states.push_back({"equal singular values", 0.7 * random_rotation(random)});
  states.push_back({"equal singular values, two", random_rotation(random) * diagonal(1.5, 0.8, 0.8)});
  const Mat3d A = random_deformation(random);
  states.push_back({"J = 1e-8, small", std::cbrt(1e-8 / determinant(A)) * A});
  const bool has_limit = std::is_same_v<M, Gent> || std::is_same_v<M, Ogden>;  // of strains that change the shape
  if (!std::is_same_v<M, Fung> && !std::is_same_v<M, NeoHookeanFibres>) {      // their exponentials overflow in these
    if (!has_limit) states.push_back({"J = 1e-8, flat", {{1, 0, 0, 0.25, 1, 0, -0.5, 0.125, 1e-8}}});
    states.push_back({"|F| = 1e6", 1e6 / std::sqrt(squared_norm(A)) * A});
  }
  if (M::info().barrier) return states;
  states.push_back({"J < 0, inverted", random_rotation(random) * diagonal(1.2, 0.9, -0.5) * random_rotation(random)});
  states.push_back({"|F| = 1e6, inverted", 1e6 * (random_rotation(random) * diagonal(0.9, 0.4, -0.1))});
  if (!std::is_same_v<M, Arap> && !std::is_same_v<M, Corotated>) {
    states.push_back({"F = 0", 0.0 * I});
    states.push_back({"J < 0, mirror image", diagonal(1, 1, -1)});
  }
  return states;
}

template <std::size_t N>
double largest(const double (&a)[N]) {
  double most = 0;
  for (const double x : a) most = std::isnan(x) ? x : std::fmax(most, std::abs(x));
  return most;
}

template <std::size_t N>
double largest_difference(const double (&a)[N], const double (&b)[N]) {
  double d[N];
  for (std::size_t i = 0; i < N; ++i) d[i] = a[i] - b[i];
  return largest(d);
}

}  // namespace aspic
