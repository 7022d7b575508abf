#include "math/svd3.h"

#include <cmath>
#include <limits>
#include <utility>

#include "math/symmetric_eigen.h"

namespace aspic {
namespace {

Vec3d column(const Mat3d& A, int c) { return {{A(0, c), A(1, c), A(2, c)}}; }

void rotate_columns(const JacobiRotation& r, Mat3d& A, int i, int j) {
  for (int k = 0; k < 3; ++k) rotate(r, A(k, i), A(k, j));
}

// Swaps two columns and turns one around: a rotation, so the determinant stays.
void swap_columns(Mat3d& A, int i, int j) {
  for (int k = 0; k < 3; ++k) {
    std::swap(A(k, i), A(k, j));
    A(k, i) = -A(k, i);
  }
}

// Turns B and V by the same rotations until the columns of B are orthogonal to working precision.
void orthogonalise_columns(Mat3d& B, Mat3d& V) {
  constexpr int kMaxSweeps = 20;
  constexpr double kOrthogonal = std::numeric_limits<double>::epsilon();
  bool rotated = true;
  for (int sweep = 0; rotated && sweep < kMaxSweeps; ++sweep) {
    rotated = false;
    for (int j = 1; j < 3; ++j)
      for (int i = 0; i < j; ++i) {
        const Vec3d bi = column(B, i), bj = column(B, j);
        const double aii = dot(bi, bi), ajj = dot(bj, bj), aij = dot(bi, bj);
        if (!(std::abs(aij) > kOrthogonal * std::sqrt(aii) * std::sqrt(ajj))) continue;
        rotated = true;
        const JacobiRotation r = jacobi_rotation(aii, ajj, aij);
        rotate_columns(r, B, i, j);
        rotate_columns(r, V, i, j);
      }
  }
}

Vec3d any_perpendicular(const Vec3d& u) {
  int least = 0;
  for (int k = 1; k < 3; ++k)
    if (std::abs(u[k]) < std::abs(u[least])) least = k;
  Vec3d axis{};
  axis[least] = 1;
  const Vec3d w = cross(u, axis);
  return (1 / std::sqrt(dot(w, w))) * w;
}

Vec3d unit(const Vec3d& x, double length) { return {{x[0] / length, x[1] / length, x[2] / length}}; }

}  // namespace

Svd3<double> svd3(const Mat3d& F) {
  Svd3<double> f{identity3<double>(), {}, identity3<double>()};
  double scale = 0;  // so that squares neither overflow nor vanish
  for (const double a : F.a) scale = std::fmax(scale, std::abs(a));
  if (!(scale > 0)) return f;
  Mat3d B;
  for (int i = 0; i < 9; ++i) B.a[i] = F.a[i] / scale;
  orthogonalise_columns(B, f.V);

  const auto squared_length = [&B](int c) { return dot(column(B, c), column(B, c)); };
  for (const auto& [i, j] : {std::pair{0, 1}, std::pair{1, 2}, std::pair{0, 1}}) {
    if (squared_length(i) >= squared_length(j)) continue;
    swap_columns(B, i, j);
    swap_columns(f.V, i, j);
  }

  const double length0 = std::sqrt(squared_length(0)), length1 = std::sqrt(squared_length(1));
  const Vec3d u0 = unit(column(B, 0), length0);
  const Vec3d u1 = length1 > 0 ? unit(column(B, 1), length1) : any_perpendicular(u0);
  const Vec3d u2 = cross(u0, u1);
  f.U = from_columns(u0, u1, u2);
  f.s = {{scale * length0, scale * length1, scale * dot(u2, column(B, 2))}};
  return f;
}

Svd3<Pack> svd3(const Mat3<Pack>& F) {
  Svd3<Pack> f;
  for (int lane = 0; lane < kPackWidth; ++lane) {
    Mat3d Fl;
    for (int i = 0; i < 9; ++i) Fl.a[i] = F.a[i][lane];
    const Svd3<double> fl = svd3(Fl);
    for (int i = 0; i < 9; ++i) {
      f.U.a[i].set(lane, fl.U.a[i]);
      f.V.a[i].set(lane, fl.V.a[i]);
    }
    for (int i = 0; i < 3; ++i) f.s[i].set(lane, fl.s[i]);
  }
  return f;
}

}  // namespace aspic
