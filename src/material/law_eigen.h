// Eigenvalues and eigenvectors of the Hessian of psi(I1, J), from the singular values of F [Smith 2019]. In the frames
// of F = U diag(s) V', the Hessian decouples into the 3x3 matrix of the stretches and, for each pair i < j, a twist
// (E_ij - E_ji) and a flip (E_ij + E_ji) with the eigenvalues 2 psi_I +- psi_J s_k.
#pragma once
#include <cmath>

#include "material/from_invariants.h"
#include "math/svd3.h"
#include "math/symmetric_eigen.h"

namespace aspic {

// Hessian with respect to the stretches: 2 psi_I Id + psi_J (s_k at i, j) + psi_JJ c c' + 4 psi_II s s' + 2 psi_IJ (s
// c' + c s'), c_i = dJ/ds_i = s_j s_k.
template <class T>
std::array<T, 9> stretch_hessian(const Vec3<T>& s, const LawDerivatives<T>& d) {
  std::array<T, 9> A;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      const T ci = s[(i + 1) % 3] * s[(i + 2) % 3], cj = s[(j + 1) % 3] * s[(j + 2) % 3];
      A[i + 3 * j] = (i == j ? d.dI + d.dI : d.dJ * s[3 - i - j]) + d.dJJ * ci * cj + T(4.0) * d.dII * s[i] * s[j] +
                     T(2.0) * d.dIJ * (s[i] * cj + ci * s[j]);
    }
  return A;
}

// vec += x vec(u_i v_j')
template <class T>
void add_framed(const Svd3<T>& f, int i, int j, const T& x, T* vec) {
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) vec[r + 3 * c] = vec[r + 3 * c] + x * f.U(r, i) * f.V(c, j);
}

template <class T>
SymmetricEigen<9, T> law_eigen(const Mat3<T>& F, const LawDerivatives<T>& d) {
  const Svd3<T> f = svd3(F);
  SymmetricEigen<9, T> e;
  for (T& x : e.vectors) x = T(0.0);
  const SymmetricEigen<3, T> stretches = symmetric_eigen<3>(stretch_hessian(f.s, d));
  for (int k = 0; k < 3; ++k) {
    T *stretch = &e.vectors[9 * k], *twist = &e.vectors[9 * (3 + k)], *flip = &e.vectors[9 * (6 + k)];
    for (int i = 0; i < 3; ++i) add_framed(f, i, i, stretches.vectors[3 * k + i], stretch);
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const T half_root = T(std::sqrt(0.5));
    add_framed(f, i, j, half_root, twist);
    add_framed(f, j, i, -half_root, twist);
    add_framed(f, i, j, half_root, flip);
    add_framed(f, j, i, half_root, flip);
    e.values[k] = stretches.values[k];
    e.values[3 + k] = d.dI + d.dI + d.dJ * f.s[k];
    e.values[6 + k] = d.dI + d.dI - d.dJ * f.s[k];
  }
  return e;
}
template <class T>
SymmetricEigen<9, T> law_eigen(const Mat3<T>& F, const LawDerivativesLinearInI1<T>& d) {
  return law_eigen(F, LawDerivatives<T>{d.dI, d.dJ, T(0.0), T(0.0), d.dJJ});
}

}  // namespace aspic
