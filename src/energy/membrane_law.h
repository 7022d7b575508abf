// Stress and Hessian of the energy densities of sheets, see membrane.h, for one deformation gradient F = [f1 f2] (3x2).
#pragma once
#include <array>

#include "energy/membrane.h"
#include "linalg/projection.h"
#include "math/eigen2.h"
#include "math/symmetric_eigen.h"

namespace aspic {

// Deformation of a triangle.
struct SheetDeformation {
  Vec3d f1, f2;
  Vec3d normal;  // f1 x f2
  double J;      // |f1 x f2|, current area per rest area
  Sym2 C;        // F'F

  SheetDeformation(const Vec3d& first, const Vec3d& second);
};

// Orthonormal axes t1, t2 of the tangent plane and the normal n, with F = [t1 t2] G.
struct SheetFrame {
  Vec3d t1, t2, n;
  std::array<double, 4> G;  // column-major, upper triangular with a nonnegative diagonal

  explicit SheetFrame(const SheetDeformation& d);
};

// d2psi/dF2. Motions in the tangent plane and along the normal do not couple.
struct SheetHessian {
  std::array<double, 16> in_plane;  // of dG, in the order of G, column-major
  Sym2 normal;                      // of n'dF; the second Piola-Kirchhoff stress
};

// The constants of a density in the axes of the warp.
class SheetModuli {
 public:
  explicit SheetModuli(const MembraneLaw& law);

  double density(const SheetDeformation& d) const;  // psi [J/m^3]
  Sym2 stress(const SheetDeformation& d) const;     // second Piola-Kirchhoff stress S = 2 dpsi/dC [Pa]
  SheetHessian hessian(const SheetDeformation& d, const SheetFrame& frame) const;  // without the limit of stretches
  // Modifies H, the Hessian at d without the limit of stretches, unless it is positive semidefinite. Returns whether it
  // did.
  bool project(const SheetDeformation& d, const SheetFrame& frame, Definiteness kind, SheetHessian& H) const;

  // Adds the Hessian of the limit of stretches, which is positive semidefinite.
  void add_limit(const SheetDeformation& d, const SheetFrame& frame, SheetHessian& H) const;

 private:
  bool is_limited(const SheetDeformation& d) const;     // false: no stretch is near the limit
  double law_density(const SheetDeformation& d) const;  // without the limit
  Sym2 law_stress(const SheetDeformation& d) const;
  SymmetricEigen<4> in_plane_eigen(const SheetDeformation& d, const SheetFrame& frame, const SheetHessian& H) const;

  bool is_orthotropic_;
  std::array<double, 4> c_;  // mu and la, or Q1, Q2, Q12 and G
  StretchLimit limit_;
};

}  // namespace aspic
