#include "contact/contact_stencil.h"

#include <algorithm>

#include "math/symmetric_eigen.h"

namespace aspic {
namespace {

EigenvalueFilter filter_of(Definiteness kind) {
  return kind == Definiteness::absolute ? EigenvalueFilter::absolute : EigenvalueFilter::clamp;
}

// c = |u x v|^2 for the directions u = x1 - x0 and v = x3 - x2 of two edges, with derivatives.
struct CrossSquared {
  double value;
  std::array<Vec3d, 4> gradient;
  DistanceHessian hessian;

  CrossSquared(const Vec3d& u, const Vec3d& v) {
    const double uu = dot(u, u), vv = dot(v, v), uv = dot(u, v);
    value = squared_norm(cross(u, v));
    const Vec3d du = 2.0 * (vv * u - uv * v), dv = 2.0 * (uu * v - uv * u);
    gradient = {-1.0 * du, du, -1.0 * dv, dv};
    const Mat3d I = identity3<double>();
    const Mat3d uu2 = 2.0 * (vv * I - outer(v, v)), vv2 = 2.0 * (uu * I - outer(u, u));
    const Mat3d uv2 = 4.0 * outer(u, v) - 2.0 * uv * I - 2.0 * outer(v, u), vu2 = transpose(uv2);
    constexpr double sign[] = {-1, 1, -1, 1};
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j <= i; ++j) hessian(i, j) = sign[i] * sign[j] * (i < 2 ? uu2 : j >= 2 ? vv2 : vu2);
  }
};

// The factor m(c) = (2 - c/eps) c/eps for c < eps, else 1.
struct Mollifier {
  double value = 1, first = 0, second = 0;
  Mollifier(double c, double eps) {
    if (c >= eps) return;
    value = (2 - c / eps) * c / eps;
    first = (2 - 2 * c / eps) / eps;
    second = -2 / (eps * eps);
  }
  bool is_one() const { return second == 0; }
};

void filter_eigenvalues(EigenvalueFilter filter, DistanceHessian& H) {
  std::array<double, 144> A;
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j <= i; ++j) {
      const Mat3d& block = H(i / 3, j / 3);
      A[i + 12 * j] = A[j + 12 * i] = block(i % 3, j % 3);
    }
  const auto e = symmetric_eigen<12>(A);
  H = {};
  for (int k = 0; k < 12; ++k) {
    const double l = filter == EigenvalueFilter::absolute ? std::abs(e.values[k]) : std::max(e.values[k], 0.0);
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j <= i; ++j)
        for (int c = 0; c < 3; ++c)
          for (int r = 0; r < 3; ++r)
            H(i, j)(r, c) += l * e.vectors[12 * k + 3 * i + r] * e.vectors[12 * k + 3 * j + c];
  }
}

CrossSquared cross_of(const ContactStencil& s, std::span<const Vec3d> x) {
  return {x[s.point[1]] - x[s.point[0]], x[s.point[3]] - x[s.point[2]]};
}

// Maps a Hessian from the points on which the distance depends to those of the query.
DistanceHessian spread(const DistanceHessian& H, const Distance& distance) {
  DistanceHessian all;
  for (int i = 0; i < distance.count; ++i)
    for (int j = 0; j <= i; ++j) {
      const int a = distance.point[i], b = distance.point[j];
      if (a >= b)
        all(a, b) = H(i, j);
      else
        all(b, a) = transpose(H(i, j));
    }
  return all;
}

}  // namespace

double ContactStencil::value(std::span<const Vec3d> x) const {
  const double V = weight * b().value;
  return parallel > 0 && V > 0 ? Mollifier(cross_of(*this, x).value, parallel).value * V : V;
}

std::array<Vec3d, 4> ContactStencil::gradient(std::span<const Vec3d> x) const {
  std::array<Vec3d, 4> g = {};
  const BarrierValue barrier = b();
  for (int k = 0; k < distance.count; ++k)
    g[distance.point[k]] = (weight * barrier.first * distance.c[k]) * distance.normal();
  if (parallel == 0) return g;
  const CrossSquared c = cross_of(*this, x);
  const Mollifier m(c.value, parallel);
  if (m.is_one()) return g;
  for (int i = 0; i < 4; ++i) g[i] = m.value * g[i] + (m.first * weight * barrier.value) * c.gradient[i];
  return g;
}

DistanceHessian ContactStencil::hessian(std::span<const Vec3d> x, Definiteness kind) const {
  const BarrierValue barrier = b();
  const DistanceSlopes slopes{weight * barrier.first, weight * barrier.second};
  if (is_over_plane()) {  // a plane has no curvature, and b is convex
    DistanceHessian H;
    H(0, 0) = slopes.second * outer(distance.normal(), distance.normal());
    return H;
  }
  const auto plain = [&](bool is_exact) {
    return spread(
        is_exact ? distance_hessian(distance, slopes) : filtered_distance_hessian(distance, slopes, filter_of(kind)),
        distance);
  };
  const bool is_exact = kind == Definiteness::exact;
  if (parallel == 0) return plain(is_exact);
  const CrossSquared c = cross_of(*this, x);
  const Mollifier m(c.value, parallel);
  if (m.is_one()) return plain(is_exact);
  DistanceHessian H = m.value > 0 ? plain(true) : DistanceHessian{};
  std::array<Vec3d, 4> db = {};
  for (int k = 0; k < distance.count; ++k) db[distance.point[k]] = (slopes.first * distance.c[k]) * distance.normal();
  const double V = weight * barrier.value;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j <= i; ++j)
      H(i, j) = m.value * H(i, j) + (V * m.first) * c.hessian(i, j) +
                (V * m.second) * outer(c.gradient[i], c.gradient[j]) +
                m.first * (outer(c.gradient[i], db[j]) + outer(db[i], c.gradient[j]));
  if (!is_exact) filter_eigenvalues(filter_of(kind), H);
  return H;
}

}  // namespace aspic
