#include "energy/load_points.h"

#include <algorithm>

#include "energy/quadratic_face.h"
#include "mesh/tet_nodes.h"
#include "mesh/tet_shape.h"

namespace aspic {
namespace {

struct LoadPoint {
  std::array<double, 4> l;  // barycentric coordinates
  double weight;            // relative to the size of the element
};

// Degree 4 [Dunavant 1985].
constexpr std::array<LoadPoint, 6> face_rule() {
  constexpr double a = 0.44594849091596488632, b = 0.091576213509770743460;
  constexpr double w = 0.22338158967801146570, v = 0.10995174365532186764;
  return {{{{1 - 2 * a, a, a}, w},
           {{a, 1 - 2 * a, a}, w},
           {{a, a, 1 - 2 * a}, w},
           {{1 - 2 * b, b, b}, v},
           {{b, 1 - 2 * b, b}, v},
           {{b, b, 1 - 2 * b}, v}}};
}

// Degree 5 [Walkington 2000].
constexpr std::array<LoadPoint, 14> tet_rule() {
  constexpr double a = 0.31088591926330060980, b = 0.092735250310891226402, c = 0.045503704125649649492, d = 0.5 - c;
  constexpr double u = 0.11268792571801585080, v = 0.073493043116361949544, w = 0.042546020777081466438;
  return {{{{1 - 3 * a, a, a, a}, u},
           {{a, 1 - 3 * a, a, a}, u},
           {{a, a, 1 - 3 * a, a}, u},
           {{a, a, a, 1 - 3 * a}, u},
           {{1 - 3 * b, b, b, b}, v},
           {{b, 1 - 3 * b, b, b}, v},
           {{b, b, 1 - 3 * b, b}, v},
           {{b, b, b, 1 - 3 * b}, v},
           {{c, c, d, d}, w},
           {{c, d, c, d}, w},
           {{c, d, d, c}, w},
           {{d, c, c, d}, w},
           {{d, c, d, c}, w},
           {{d, d, c, c}, w}}};
}

constexpr std::array<LoadPoint, 6> kFaceRule = face_rule();
constexpr std::array<LoadPoint, 14> kTetRule = tet_rule();

std::array<double, 10> shapes(const LoadElement& element, const std::array<double, 4>& l) {
  if (element.node_count == 10) return quadratic_shapes(l);
  std::array<double, 10> N{};
  if (element.node_count == 6) {
    const std::array<double, 6> of_face = face_shapes({l[0], l[1], l[2]});
    std::copy(of_face.begin(), of_face.end(), N.begin());
  } else {
    std::copy(l.begin(), l.end(), N.begin());
  }
  return N;
}

}  // namespace

LoadElement load_element(const TetMesh& mesh, int tet) {
  const TetNodes nodes = nodes_of(mesh, tet);
  return {.node = nodes.node,
          .corner_count = 4,
          .node_count = nodes.count,
          .corner = corners(mesh, tet),
          .normal = {},
          .size = volume(mesh, tet)};
}

LoadElement load_element(const std::vector<Vec3d>& X, const Face& face) {
  const auto& [a, b, c] = face.corners;
  LoadElement element{.corner_count = 3, .node_count = face.is_quadratic() ? 6 : 3, .corner = {X[a], X[b], X[c]}};
  std::copy_n(nodes_of(face).begin(), element.node_count, element.node.begin());
  element.normal = cross(X[b] - X[a], X[c] - X[a]);
  element.size = norm(element.normal) / 2;
  return element;
}

void add_load(const LoadElement& element, FunctionRef<Vec3d(const Vec3d&)> load, std::span<double> force) {
  const std::span<const LoadPoint> rule =
      element.corner_count == 4 ? std::span<const LoadPoint>(kTetRule) : std::span<const LoadPoint>(kFaceRule);
  for (const LoadPoint& point : rule) {
    Vec3d X{};
    for (int c = 0; c < element.corner_count; ++c) X = X + point.l[c] * element.corner[c];
    const Vec3d f = (element.size * point.weight) * load(X);
    const std::array<double, 10> N = shapes(element, point.l);
    for (int n = 0; n < element.node_count; ++n)
      for (int r = 0; r < 3; ++r) force[3 * element.node[n] + r] += N[n] * f[r];
  }
}

}  // namespace aspic
