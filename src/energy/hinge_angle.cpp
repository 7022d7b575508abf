#include "energy/hinge_angle.h"

#include <cmath>
#include <limits>

namespace aspic {
namespace {

constexpr double kNegligible = 1e-12;  // change of the angle whose contribution to the Hessian stays unmodified

// Returns [p q] S [r s]'.
Mat3d framed(const Vec3d& p, const Vec3d& q, const Sym2& S, const Vec3d& r, const Vec3d& s) {
  return outer(p, S.xx * r + S.xy * s) + outer(q, S.xy * r + S.yy * s);
}

Sym2 modified(const Sym2& A, Definiteness kind) {
  Eigen2 e = symmetric_eigen(A);
  for (double* l : {&e.high, &e.low})
    if (*l < 0) *l = kind == Definiteness::absolute ? -*l : 0;
  return from_eigen(e);
}

Sym2 half_sum(const Sym2& A, const Sym2& B, double sign) {
  return {0.5 * (A.xx + sign * B.xx), 0.5 * (A.yy + sign * B.yy), 0.5 * (A.xy + sign * B.xy)};
}

}  // namespace

// sin and cos are multiplied by |N1| |N2|: (N1 x N2) . e = -|e|^2 N1 . (d - a) for N1 = e x (c - a), N2 = (d - a) x e.
double hinge_angle(const HingeCorners& x) {
  const Vec3d e = x[1] - x[0], q = x[3] - x[0], N1 = cross(e, x[2] - x[0]), N2 = cross(q, e);
  if (!(dot(N1, N1) > 0 && dot(N2, N2) > 0)) return std::numeric_limits<double>::quiet_NaN();
  return std::atan2(norm(e) * dot(N1, q), dot(N1, N2));
}

// dtheta = sum normal . delta / height, see HingeShape; normal / height = |e| N / (N . N).
HingeGradient hinge_gradient(const HingeCorners& x) {
  const Vec3d e = x[1] - x[0], p = x[2] - x[0], q = x[3] - x[0], N1 = cross(e, p), N2 = cross(q, e);
  const double squared_length = dot(e, e), length = std::sqrt(squared_length), inverse = 1 / squared_length;
  const double s = dot(p, e) * inverse, r = dot(q, e) * inverse;
  const Vec3d g_c = (length / dot(N1, N1)) * N1, g_d = (length / dot(N2, N2)) * N2;
  return {std::atan2(length * dot(N1, q), dot(N1, N2)), {(s - 1) * g_c + (r - 1) * g_d, -s * g_c - r * g_d, g_c, g_d}};
}

HingeShape::HingeShape(const HingeCorners& x) {
  const Vec3d e = x[1] - x[0], p = x[2] - x[0], q = x[3] - x[0], N1 = cross(e, p), N2 = cross(q, e);
  length = norm(e);
  axis = (1 / length) * e;
  angle = std::atan2(length * dot(N1, q), dot(N1, N2));
  const double area1 = norm(N1), area2 = norm(N2);
  const Vec3d n1 = (1 / area1) * N1, n2 = (1 / area2) * N2;
  wing[0] = {dot(p, axis) / length, area1 / length, n1, cross(n1, axis)};
  wing[1] = {dot(q, axis) / length, area2 / length, n2, cross(axis, n2)};
}

HingeHessian::HingeHessian(const HingeShape& shape, double change, Definiteness kind, double slope_weight)
    : is_modified_(kind != Definiteness::exact && std::abs(change) > kNegligible) {
  const HalfAngle half = {std::cos(0.5 * shape.angle), std::sin(0.5 * shape.angle)};
  const double root2 = std::sqrt(2.0), sin = 2 * half.sin * half.cos;
  std::array<Sym2, 4> parts = {{{2 * slope_weight, 0, -change},
                                {0, 0, -change},
                                {-change * sin, 0, -change * root2 * half.cos},
                                {change * sin, 0, -change * root2 * half.sin}}};
  if (is_modified_)
    for (Sym2& part : parts) part = modified(part, kind);
  assemble(shape, half, parts);
}

void HingeHessian::assemble(const HingeShape& shape, const HalfAngle& half, const std::array<Sym2, 4>& parts) {
  const auto& [plus, minus, along_x, along_y] = parts;
  const auto& [w1, w2] = shape.wing;
  const Vec3d axis = shape.axis;
  const Vec3d x = half.cos * w1.normal + half.sin * w1.outward, y = half.sin * w1.normal - half.cos * w1.outward;

  // Blocks of (delta_1, delta_2, epsilon).
  const Sym2 same = half_sum(plus, minus, 1), other = half_sum(plus, minus, -1);
  const Mat3d axial = outer(axis, axis);
  const double i1 = 1 / w1.height, i2 = 1 / w2.height, il = 1 / shape.length, ie = std::sqrt(0.5) * il;
  const double axial_same = 0.5 * (along_x.yy + along_y.yy), axial_other = 0.5 * (along_x.yy - along_y.yy);
  const Mat3d G11 = (i1 * i1) * (framed(w1.normal, w1.outward, same, w1.normal, w1.outward) + axial_same * axial);
  const Mat3d G22 = (i2 * i2) * (framed(w2.normal, w2.outward, same, w2.normal, w2.outward) + axial_same * axial);
  const Mat3d G12 = (i1 * i2) * (framed(w1.normal, w1.outward, other, w2.normal, w2.outward) + axial_other * axial);
  const Mat3d G1e = outer((i1 * ie) * axis, along_x.xy * x + along_y.xy * y);
  const Mat3d G2e = outer((i2 * ie) * axis, along_x.xy * x - along_y.xy * y);
  const Mat3d Gee = (il * il) * (outer(along_x.xx * x, x) + outer(along_y.xx * y, y));

  const double s = w1.share, r = w2.share;
  K_[2][2] = G11;
  K_[3][3] = G22;
  K_[2][3] = G12;
  K_[3][2] = transpose(G12);
  K_[2][1] = G1e - s * G11 - r * G12;
  K_[3][1] = G2e - s * K_[3][2] - r * G22;
  K_[1][2] = transpose(K_[2][1]);
  K_[1][3] = transpose(K_[3][1]);
  K_[1][1] = Gee - s * (K_[2][1] + transpose(G1e)) - r * (K_[3][1] + transpose(G2e));
  for (int v = 1; v < 4; ++v) {  // translations cause no force
    K_[0][v] = -1.0 * (K_[1][v] + K_[2][v] + K_[3][v]);
    K_[v][0] = transpose(K_[0][v]);
  }
  K_[0][0] = -1.0 * (K_[0][1] + K_[0][2] + K_[0][3]);
}

}  // namespace aspic
