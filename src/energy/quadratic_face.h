// Shape functions of a quadratic face: corners first, then the mid-edge nodes after each corner.
#pragma once
#include <array>

#include "mesh/surface.h"

namespace aspic {

inline std::array<int, 6> nodes_of(const Face& face) {
  return {face.corners[0], face.corners[1], face.corners[2], face.mids[0], face.mids[1], face.mids[2]};
}

// Returns N_n at barycentric coordinates l.
constexpr std::array<double, 6> face_shapes(const std::array<double, 3>& l) {
  std::array<double, 6> N{};
  for (int i = 0; i < 3; ++i) {
    N[i] = l[i] * (2 * l[i] - 1);
    N[3 + i] = 4 * l[i] * l[(i + 1) % 3];
  }
  return N;
}

// Returns dN_n/dl_i, the coordinates being independent.
constexpr std::array<double, 6> face_derivatives(const std::array<double, 3>& l, int i) {
  std::array<double, 6> d{};
  d[i] = 4 * l[i] - 1;
  d[3 + i] = 4 * l[(i + 1) % 3];
  d[3 + (i + 2) % 3] = 4 * l[(i + 2) % 3];
  return d;
}

// A linear triangle that has the position and the tangents of a quadratic face at one of its quadrature points: corner
// k is the sum of shares[k][n] x_n. The six points integrate polynomials of degree 4 exactly [Dunavant 1985].
struct FacePoint {
  double weight;  // relative to the area
  std::array<std::array<double, 6>, 3> shares;
};

constexpr FacePoint face_point(const std::array<double, 3>& l, double weight) {
  const std::array<double, 6> N = face_shapes(l), d0 = face_derivatives(l, 0), d1 = face_derivatives(l, 1),
                              d2 = face_derivatives(l, 2);
  FacePoint point{weight, {}};
  for (int n = 0; n < 6; ++n) {
    const double along1 = d1[n] - d0[n], along2 = d2[n] - d0[n];  // derivatives along the edges from corner 0
    point.shares[0][n] = N[n] - (along1 + along2) / 3;
    point.shares[1][n] = point.shares[0][n] + along1;
    point.shares[2][n] = point.shares[0][n] + along2;
  }
  return point;
}

constexpr std::array<FacePoint, 6> face_points() {
  constexpr double a = 0.44594849091596488632, b = 0.091576213509770743460;
  constexpr double w = 0.22338158967801146570, v = 0.10995174365532186764;
  return {face_point({1 - 2 * a, a, a}, w), face_point({a, 1 - 2 * a, a}, w), face_point({a, a, 1 - 2 * a}, w),
          face_point({1 - 2 * b, b, b}, v), face_point({b, 1 - 2 * b, b}, v), face_point({b, b, 1 - 2 * b}, v)};
}
inline constexpr std::array<FacePoint, 6> kFacePoints = face_points();

inline constexpr FacePoint kLinearPoint = {1, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};  // of a linear face itself

}  // namespace aspic
