// Eigenvalues and eigenvectors of a symmetric 2x2 matrix.
#pragma once

namespace aspic {

struct Sym2 {
  double xx, yy, xy;
};

struct Eigen2 {
  double high, low;  // eigenvalues
  double cos, sin;   // (cos, sin) is the eigenvector of the larger one, (-sin, cos) that of the other
};
Eigen2 symmetric_eigen(const Sym2& A);

// Returns the matrix with these eigenvalues and eigenvectors.
inline Sym2 from_eigen(const Eigen2& e) {
  const double cc = e.cos * e.cos, ss = e.sin * e.sin;
  return {e.high * cc + e.low * ss, e.high * ss + e.low * cc, (e.high - e.low) * e.cos * e.sin};
}

}  // namespace aspic
