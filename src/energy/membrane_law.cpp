#include "energy/membrane_law.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "math/definite.h"

namespace aspic {
namespace {

constexpr double kEqual = 1e-5;       // relative difference of stretches below which they count as equal
constexpr double kTolerance = 1e-12;  // of negative eigenvalues, relative to the largest diagonal entry

// dS = D (dE11, dE22, 2 dE12)
struct Tangent {
  double xx_xx, yy_yy, xx_yy, xx_xy, yy_xy, xy_xy;
};

// S = mu I + p C^-1, p = la ln J - mu; dS = la (C^-1 : dE) C^-1 - 2 p C^-1 dE C^-1.
Tangent neo_hookean_tangent(const Sym2& Ci, double la, double p) {
  const double q = la - 2 * p;
  return {q * Ci.xx * Ci.xx, q * Ci.yy * Ci.yy, la * Ci.xx * Ci.yy - 2 * p * Ci.xy * Ci.xy,
          q * Ci.xx * Ci.xy, q * Ci.yy * Ci.xy, la * Ci.xy * Ci.xy - p * (Ci.xx * Ci.yy + Ci.xy * Ci.xy)};
}

Sym2 inverse_of_C(const SheetDeformation& d) {
  const double s = 1 / (d.J * d.J);
  return {s * d.C.yy, s * d.C.xx, -s * d.C.xy};
}

// dS_cd = D (dE), dE = sym(G'dG). The first part of the Hessian of dG is S_cd delta_rs.
std::array<double, 16> in_plane_hessian(const std::array<double, 4>& G, const Sym2& S, const Tangent& D) {
  // w[k]: derivatives of (E11, E22, 2 E12) with respect to entry k of G.
  const double w[4][3] = {{G[0], 0, G[2]}, {G[1], 0, G[3]}, {0, G[2], G[0]}, {0, G[3], G[1]}};
  std::array<double, 16> H;
  for (int k = 0; k < 4; ++k) {
    const double Dw[3] = {D.xx_xx * w[k][0] + D.xx_yy * w[k][1] + D.xx_xy * w[k][2],
                          D.xx_yy * w[k][0] + D.yy_yy * w[k][1] + D.yy_xy * w[k][2],
                          D.xx_xy * w[k][0] + D.yy_xy * w[k][1] + D.xy_xy * w[k][2]};
    for (int m = 0; m <= k; ++m) H[k + 4 * m] = H[m + 4 * k] = w[m][0] * Dw[0] + w[m][1] * Dw[1] + w[m][2] * Dw[2];
  }
  for (int r = 0; r < 2; ++r) {
    H[5 * r] += S.xx;
    H[5 * (r + 2)] += S.yy;
    H[r + 4 * (r + 2)] += S.xy;
    H[r + 2 + 4 * r] += S.xy;
  }
  return H;
}

double largest_diagonal(const SheetHessian& H) {
  double largest = std::max(std::abs(H.normal.xx), std::abs(H.normal.yy));
  for (int k = 0; k < 4; ++k) largest = std::max(largest, std::abs(H.in_plane[5 * k]));
  return largest;
}

// Returns whether A + shift Id = L D L' has positive D.
bool is_positive(const std::array<double, 16>& A, double shift) {
  double L[4][4];  // L D below the diagonal, 1 / D on it
  for (int k = 0; k < 4; ++k) {
    double d = A[5 * k] + shift;
    for (int m = 0; m < k; ++m) d -= L[k][m] * L[k][m] * L[m][m];
    if (!(d > 0)) return false;
    L[k][k] = 1 / d;
    for (int i = k + 1; i < 4; ++i) {
      L[i][k] = A[i + 4 * k];
      for (int m = 0; m < k; ++m) L[i][k] -= L[i][m] * L[k][m] * L[m][m];
    }
  }
  return true;
}

bool is_positive(const Sym2& A, double shift) {
  const double xx = A.xx + shift, yy = A.yy + shift;
  return xx > 0 && xx * yy > A.xy * A.xy;
}

// Returns the replacement of the eigenvalue l.
double filtered(double l, Definiteness kind, double floor) {
  return std::max(kind == Definiteness::absolute ? std::abs(l) : l, floor);
}

// The principal stretches s and axes: F = u1 s1 v1' + u2 s2 v2'. Scalings u_i v_i', then the flip u1 v2' + u2 v1' and
// the twist u1 v2' - u2 v1', divided by sqrt(2), are the vectors of `modes`, 4 numbers each.
struct PrincipalModes {
  double s1, s2;
  std::array<double, 16> modes;

  PrincipalModes(const SheetDeformation& d, const SheetFrame& frame) {
    const Eigen2 principal = symmetric_eigen(d.C);
    const double v1[2] = {principal.cos, principal.sin}, v2[2] = {-principal.sin, principal.cos};
    s1 = std::sqrt(principal.high), s2 = d.J / s1;
    double u1[2], u2[2];
    for (int r = 0; r < 2; ++r) u1[r] = (frame.G[r] * v1[0] + frame.G[r + 2] * v1[1]) / s1;
    u2[0] = -u1[1], u2[1] = u1[0];  // G has a positive determinant
    const double h = std::sqrt(0.5);
    for (int c = 0; c < 2; ++c)
      for (int r = 0; r < 2; ++r) {
        const double across = u1[r] * v2[c], back = u2[r] * v1[c];
        const int k = r + 2 * c;
        modes[k] = u1[r] * v1[c];
        modes[k + 4] = u2[r] * v2[c];
        modes[k + 8] = h * (across + back);
        modes[k + 12] = h * (across - back);
      }
  }
};

// The energy of a stretch and its derivatives.
struct LimitLaw {
  double energy = 0, slope = 0, curvature = 0;

  LimitLaw(const StretchLimit& limit, double s) {
    const double d = s - limit.from, e = limit.to - s;
    if (!(d > 0)) return;
    if (!(e > 0)) {
      energy = std::numeric_limits<double>::infinity();
      return;
    }
    const double L = std::log(e / (limit.to - limit.from)), k = limit.stiffness, q = d / e;
    energy = -k * d * d * L;
    slope = k * d * (q - 2 * L);
    curvature = k * (4 * q + q * q - 2 * L);
  }
};

}  // namespace

SheetDeformation::SheetDeformation(const Vec3d& first, const Vec3d& second)
    : f1(first),
      f2(second),
      normal(cross(first, second)),
      J(norm(normal)),
      C{dot(first, first), dot(second, second), dot(first, second)} {}

SheetFrame::SheetFrame(const SheetDeformation& d) {
  const Vec3d& longer = d.C.xx > 0 ? d.f1 : d.f2;
  const double l = norm(longer);
  t1 = l > 0 ? (1 / l) * longer : Vec3d{{1, 0, 0}};
  if (d.J > 0) {
    n = (1 / d.J) * d.normal;
  } else {  // any normal of t1
    const Vec3d axis = std::abs(t1[0]) < 0.5 ? Vec3d{{1, 0, 0}} : Vec3d{{0, 1, 0}}, m = cross(t1, axis);
    n = (1 / norm(m)) * m;
  }
  t2 = cross(n, t1);
  G = {dot(t1, d.f1), 0, dot(t1, d.f2), dot(t2, d.f2)};
}

SheetModuli::SheetModuli(const MembraneLaw& law) : is_orthotropic_(std::holds_alternative<OrthotropicSheet>(law)) {
  if (is_orthotropic_) {
    const OrthotropicSheet& s = std::get<OrthotropicSheet>(law);
    const double share = 1 - s.poisson * s.poisson * s.weft_young / s.warp_young;
    ASPIC_CHECK(s.warp_young > 0 && s.weft_young > 0 && share > 0);
    const double Q2 = s.weft_young / share;
    c_ = {s.warp_young / share, Q2, s.poisson * Q2, s.shear};
    limit_ = s.limit;
  } else {
    const IsotropicSheet& s = std::get<IsotropicSheet>(law);
    ASPIC_CHECK(0 <= s.poisson && s.poisson < 1);
    c_ = {s.young / (2 * (1 + s.poisson)), s.young * s.poisson / (1 - s.poisson * s.poisson), 0, 0};
    limit_ = s.limit;
  }
}

bool SheetModuli::is_limited(const SheetDeformation& d) const {
  return limit_.stiffness > 0 && std::max(d.C.xx, d.C.yy) + std::abs(d.C.xy) > limit_.from * limit_.from;
}

double SheetModuli::density(const SheetDeformation& d) const {
  if (!is_limited(d)) return law_density(d);
  const double s1 = std::sqrt(symmetric_eigen(d.C).high);
  return law_density(d) + LimitLaw(limit_, s1).energy + LimitLaw(limit_, d.J / s1).energy;
}

Sym2 SheetModuli::stress(const SheetDeformation& d) const {
  Sym2 S = law_stress(d);
  if (!is_limited(d)) return S;
  const Eigen2 principal = symmetric_eigen(d.C);
  const double s1 = std::sqrt(principal.high), s2 = d.J / s1;
  const LimitLaw first(limit_, s1), second(limit_, s2);
  if (first.slope == 0) return S;
  const Sym2 more =
      from_eigen({first.slope / s1, second.slope > 0 ? second.slope / s2 : 0, principal.cos, principal.sin});
  return {S.xx + more.xx, S.yy + more.yy, S.xy + more.xy};
}

void SheetModuli::add_limit(const SheetDeformation& d, const SheetFrame& frame, SheetHessian& H) const {
  if (!is_limited(d)) return;
  const PrincipalModes p(d, frame);
  const LimitLaw first(limit_, p.s1), second(limit_, p.s2);
  if (first.slope == 0) return;
  const double apart = p.s1 - p.s2;
  const double flip =
      apart > kEqual * p.s1 ? (first.slope - second.slope) / apart : LimitLaw(limit_, 0.5 * (p.s1 + p.s2)).curvature;
  const double values[4] = {first.curvature, second.curvature, flip, (first.slope + second.slope) / (p.s1 + p.s2)};
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i) H.in_plane[i + 4 * j] += values[k] * p.modes[4 * k + i] * p.modes[4 * k + j];
  const Sym2 all = stress(d), own = law_stress(d);
  H.normal = {H.normal.xx + all.xx - own.xx, H.normal.yy + all.yy - own.yy, H.normal.xy + all.xy - own.xy};
}

double SheetModuli::law_density(const SheetDeformation& d) const {
  if (is_orthotropic_) {
    const double e1 = 0.5 * (d.C.xx - 1), e2 = 0.5 * (d.C.yy - 1);
    return 0.5 * (c_[0] * e1 * e1 + c_[1] * e2 * e2 + c_[3] * d.C.xy * d.C.xy) + c_[2] * e1 * e2;
  }
  if (!(d.J > 0)) return std::numeric_limits<double>::infinity();
  const double L = std::log(d.J);
  return 0.5 * c_[0] * (d.C.xx + d.C.yy - 2) + (0.5 * c_[1] * L - c_[0]) * L;
}

Sym2 SheetModuli::law_stress(const SheetDeformation& d) const {
  if (is_orthotropic_) {
    const double e1 = 0.5 * (d.C.xx - 1), e2 = 0.5 * (d.C.yy - 1);
    return {c_[0] * e1 + c_[2] * e2, c_[2] * e1 + c_[1] * e2, c_[3] * d.C.xy};
  }
  const double p = c_[1] * std::log(d.J) - c_[0];
  const Sym2 Ci = inverse_of_C(d);
  return {c_[0] + p * Ci.xx, c_[0] + p * Ci.yy, p * Ci.xy};
}

SheetHessian SheetModuli::hessian(const SheetDeformation& d, const SheetFrame& frame) const {
  if (is_orthotropic_) {
    const Sym2 S = law_stress(d);
    return {in_plane_hessian(frame.G, S, {c_[0], c_[1], c_[2], 0, 0, c_[3]}), S};
  }
  const double p = c_[1] * std::log(d.J) - c_[0];
  const Sym2 Ci = inverse_of_C(d), S = {c_[0] + p * Ci.xx, c_[0] + p * Ci.yy, p * Ci.xy};
  return {in_plane_hessian(frame.G, S, neo_hookean_tangent(Ci, c_[1], p)), S};
}

// In the principal axes, see PrincipalModes, with psi_i = dpsi/ds_i: the scalings couple, the flip has the eigenvalue
// (psi_1 - psi_2) / (s1 - s2) and the twist has (psi_1 + psi_2) / (s1 + s2) [Smith 2019].
SymmetricEigen<4> SheetModuli::in_plane_eigen(const SheetDeformation& d, const SheetFrame& frame,
                                              const SheetHessian& H) const {
  if (is_orthotropic_) return symmetric_eigen<4>(H.in_plane);
  const PrincipalModes principal(d, frame);
  const double s1 = principal.s1, s2 = principal.s2;
  const double mu = c_[0], la = c_[1], p = la * std::log(d.J) - mu;
  const Eigen2 scaling = symmetric_eigen(Sym2{mu + (la - p) / (s1 * s1), mu + (la - p) / (s2 * s2), la / d.J});
  SymmetricEigen<4> e;
  e.values = {scaling.high, scaling.low, mu - p / d.J, mu + p / d.J};
  e.vectors = principal.modes;
  for (int k = 0; k < 4; ++k) {
    const double first = principal.modes[k], second = principal.modes[k + 4];
    e.vectors[k] = scaling.cos * first + scaling.sin * second;
    e.vectors[k + 4] = scaling.cos * second - scaling.sin * first;
  }
  return e;
}

bool SheetModuli::project(const SheetDeformation& d, const SheetFrame& frame, Definiteness kind,
                          SheetHessian& H) const {
  const double shift = kTolerance * largest_diagonal(H) + std::numeric_limits<double>::min();
  if (kind == Definiteness::exact || (is_positive(H.normal, shift) && is_positive(H.in_plane, shift))) return false;
  const SymmetricEigen<4> e = in_plane_eigen(d, frame, H);
  const Eigen2 s = symmetric_eigen(H.normal);
  double largest = std::max(std::abs(s.high), std::abs(s.low));
  for (const double l : e.values) largest = std::max(largest, std::abs(l));
  const double floor = std::max(kEigenvalueFloor * largest, std::numeric_limits<double>::min());
  for (int k = 0; k < 4; ++k) {
    const double raise = filtered(e.values[k], kind, floor) - e.values[k];
    if (raise <= 0) continue;
    const double* v = &e.vectors[4 * k];
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i) H.in_plane[i + 4 * j] += raise * v[i] * v[j];
  }
  H.normal = from_eigen({filtered(s.high, kind, floor), filtered(s.low, kind, floor), s.cos, s.sin});
  return true;
}

}  // namespace aspic
