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

}  // namespace

Embedding embed(const TetMesh& cage, const TriMesh& skin) {
  check_finite(skin);
  const TetMesh tets = linear_parts(cage).mesh;
  const TetLocator locator(tets);
  Embedding embedding;
  embedding.vertices.resize(skin.vertices.size());
  embedding.weights.resize(skin.vertices.size());
  std::vector<char> is_outside(skin.vertices.size());
  parallel_chunks(skin.vertex_count(), [&](int first, int last) {
    for (int v = first; v < last; ++v) {
      const Located carrier = locator.locate(skin.vertices[v]);
      embedding.vertices[v] = tets.tets[carrier.tet];
      embedding.weights[v] = carrier.weights;
      is_outside[v] = carrier.is_outside();
    }
  });
  embedding.outside = static_cast<int>(std::count(is_outside.begin(), is_outside.end(), 1));
  return embedding;
}

void carry(const Embedding& embedding, std::span<const double> x, std::span<double> skin_x) {
  ASPIC_CHECK(skin_x.size() == 3 * embedding.vertices.size());
  parallel_chunks(static_cast<int>(embedding.vertices.size()), [&](int first, int last) {
    for (int v = first; v < last; ++v) {
      const Tet& tet = embedding.vertices[v];
      const std::array<double, 4>& w = embedding.weights[v];
      for (int axis = 0; axis < 3; ++axis) {
        double sum = 0;
        for (int c = 0; c < 4; ++c) sum += w[c] * x[3 * tet[c] + axis];
        skin_x[3 * v + axis] = sum;
      }
    }
  });
}

}  // namespace aspic
