#include "mesh/embed.h"

#include <algorithm>
#include <string>

#include "base/check.h"
#include "base/error.h"
#include "base/parallel.h"
#include "mesh/doctor.h"
#include "mesh/locate.h"
#include "mesh/tet_nodes.h"

namespace aspic {
namespace {

void check_finite(const TriMesh& skin) {
  for (int v = 0; v < skin.vertex_count(); ++v) {
    const Vec3d& x = skin.vertices[v];
    if (!(norm(x) <= kLargestCoordinate))
      throw InvalidInput("skin vertex " + std::to_string(v) +
                         " is not finite or beyond 1e30 m, where distances overflow; correct the file");
  }
}

// Shape functions at barycentric coordinates l; outside of the tet their tangent at a point inside, because quadratic
// functions grow fast.
Carrier carrier_in(const TetNodes& nodes, const std::array<double, 4>& l) {
  Carrier carrier{nodes.count, nodes.node, {}};
  if (nodes.count == 4) {
    std::copy(l.begin(), l.end(), carrier.weight.begin());
    return carrier;
  }
  std::array<double, 4> inside{};
  double sum = 0;
  for (int i = 0; i < 4; ++i) sum += inside[i] = std::max(l[i], 0.0);
  for (double& coordinate : inside) coordinate /= sum;
  carrier.weight = quadratic_shapes(inside);
  for (int n = 0; n < 10; ++n)
    for (int i = 0; i < 4; ++i) carrier.weight[n] += quadratic_derivative(n, i, inside) * (l[i] - inside[i]);
  return carrier;
}

}  // namespace

int Carrier::nearest_vertex() const {
  return vertex[std::max_element(weight.begin(), weight.begin() + count) - weight.begin()];
}

Vec3d Carrier::position(std::span<const double> x) const {
  Vec3d sum{};
  for (int n = 0; n < count; ++n)
    for (int axis = 0; axis < 3; ++axis) sum[axis] += weight[n] * x[3 * vertex[n] + axis];
  return sum;
}

Embedding embed(const TetMesh& cage, const TriMesh& skin) {
  check_finite(skin);
  const TetLocator locator(cage);
  Embedding embedding;
  embedding.carriers.resize(skin.vertices.size());
  std::vector<char> is_outside(skin.vertices.size());
  parallel_chunks(skin.vertex_count(), [&](int first, int last) {
    for (int v = first; v < last; ++v) {
      const Located carrier = locator.locate(skin.vertices[v]);
      embedding.carriers[v] = carrier_in(nodes_of(cage, carrier.tet), carrier.weights);
      is_outside[v] = carrier.is_outside();
    }
  });
  embedding.outside = static_cast<int>(std::count(is_outside.begin(), is_outside.end(), 1));
  return embedding;
}

void carry(const Embedding& embedding, std::span<const double> x, std::span<double> skin_x) {
  ASPIC_CHECK(skin_x.size() == 3 * embedding.carriers.size());
  parallel_chunks(static_cast<int>(embedding.carriers.size()), [&](int first, int last) {
    for (int v = first; v < last; ++v) {
      const Vec3d at = embedding.carriers[v].position(x);
      std::copy(at.a, at.a + 3, &skin_x[3 * v]);
    }
  });
}

}  // namespace aspic
