// The angle theta between two triangles (a, b, c) and (b, a, d) that share the edge (a, b), and its derivatives.
// theta in (-pi, pi] is 0 in the plane and positive if both fold toward the normal (b - a) x (c - a). Exchanging a and
// b as well as c and d changes the sign.
#pragma once
#include <array>

#include "linalg/projection.h"
#include "math/eigen2.h"
#include "math/small.h"

namespace aspic {

using HingeCorners = std::array<Vec3d, 4>;  // a, b, c, d

// Returns theta; NaN if a triangle is collapsed.
double hinge_angle(const HingeCorners& x);

struct HingeGradient {
  double angle;
  HingeCorners gradient;  // dtheta/dx [1/m]
};
HingeGradient hinge_gradient(const HingeCorners& x);

// A triangle at the edge: with p = c - a, the height h, and the foot a + share (b - a) of c.
struct HingeWing {
  double share, height;
  Vec3d normal, outward;  // unit vectors; both triangles of a plane have the same normal. outward: from the edge to c
};

// Geometry of a hinge. The derivatives of theta are those of the relative motions
//   delta_i = dc - (1 - share) da - share db of each triangle, and epsilon = db - da.
struct HingeShape {
  double angle, length;
  Vec3d axis;  // (b - a) / length
  std::array<HingeWing, 2> wing;

  explicit HingeShape(const HingeCorners& x);
};

// Hessian of (theta - theta0)^2 / 2, theta - theta0 = change: the square of dtheta/dx and change times the Hessian of
// theta.
//
// With the natural units delta_i / h_i and epsilon / length it splits into four 2x2 matrices. Let alpha_i, beta_i and
// tau_i be the components of delta_i / h_i along the normal, outward and along the axis. Let x be the mean of both
// normals, y = axis x x, and eta_x, eta_y the components of epsilon / length. Sums and differences of both triangles
// are divided by sqrt(2):
//   sums of (alpha, beta)         [2, -change; -change, 0]
//   differences of (alpha, beta)  [0, -change; -change, 0]
//   eta_x, sum of tau             change [-sin theta, -sqrt(2) cos(theta/2); ., 0]
//   eta_y, difference of tau      change [sin theta, -sqrt(2) sin(theta/2); ., 0]
// Modified Hessians replace the eigenvalues of these matrices, so they are semidefinite, but not the nearest in the
// Euclidean norm.
class HingeHessian {
 public:
  // Modifies it according to `kind`. slope_weight: factor of the square of dtheta/dx, in [0, 1].
  HingeHessian(const HingeShape& shape, double change, Definiteness kind, double slope_weight = 1);

  bool is_modified() const { return is_modified_; }
  const Mat3d& operator()(int u, int v) const { return K_[u][v]; }  // block of corners u and v

 private:
  struct HalfAngle {
    double cos, sin;  // of theta / 2
  };
  void assemble(const HingeShape& shape, const HalfAngle& half, const std::array<Sym2, 4>& parts);

  bool is_modified_;
  Mat3d K_[4][4];
};

}  // namespace aspic
