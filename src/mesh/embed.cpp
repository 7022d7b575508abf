#include "mesh/embed.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/check.h"
#include "base/error.h"
#include "base/parallel.h"
#include "mesh/box_tree.h"
#include "mesh/tet_shape.h"

namespace aspic {
namespace {

// Equal but for round-off: a point outside is often nearest to an edge or a corner that several tets share.
constexpr double kTie = 1e-9;
// A weight this far below zero is still on the face rather than outside.
constexpr double kOnFace = 1e-9;

struct Carrier {
  int tet = -1;
  double squared_distance = std::numeric_limits<double>::infinity();
  double least_weight = 0;
  std::array<double, 4> weights{};
};

double least(const std::array<double, 4>& w) { return std::min(std::min(w[0], w[1]), std::min(w[2], w[3])); }

class Cage {
 public:
  explicit Cage(const TetMesh& mesh) : mesh_(mesh), usable_(usable_tets(mesh)), tree_(boxes(mesh, usable_)) {
    if (usable_.empty()) throw InvalidInput("the cage has no tets with a volume; a skin needs some to carry it");
    for (int tet : usable_) inverse_.push_back(inverse(edge_matrix(mesh, tet)));
  }

  Carrier carrier(const Vec3d& p) const {
    const Carrier containing = container(p);
    return containing.tet >= 0 ? containing : nearest(p);
  }

 private:
  // The tet that has p deepest inside; none when p is outside.
  Carrier container(const Vec3d& p) const {
    Carrier best;
    best.least_weight = -kOnFace;
    constexpr double kHere = 0;
    tree_.for_each_near(p, kHere, [&](int item) {
      const std::array<double, 4> w = weights(item, p);
      if (least(w) >= best.least_weight) best = {usable_[item], 0, least(w), w};
    });
    return best;
  }

  // The tet nearest to p; of several, the one that extrapolates least.
  Carrier nearest(const Vec3d& p) const {
    Carrier best;
    double reach = std::numeric_limits<double>::infinity();
    tree_.for_each_near(p, reach, [&](int item) {
      const std::array<double, 4> w = weights(item, p);
      const double distance = squared_distance(corners(mesh_, usable_[item]), w, p);
      if (distance > reach) return;
      const bool nearer = distance < best.squared_distance * (1 - kTie);
      if (best.tet >= 0 && !nearer && least(w) <= best.least_weight) return;
      best = {usable_[item], distance, least(w), w};
      reach = std::min(reach, distance * (1 + kTie));
    });
    return best;
  }

  std::array<double, 4> weights(int item, const Vec3d& p) const {
    const Vec3d w = inverse_[item] * (p - mesh_.rest[mesh_.tets[usable_[item]][0]]);
    return {1 - w[0] - w[1] - w[2], w[0], w[1], w[2]};
  }

  static std::vector<int> usable_tets(const TetMesh& mesh) {
    std::vector<int> usable;
    for (int t = 0; t < mesh.tet_count(); ++t) {
      const TetCorners X = corners(mesh, t);
      if (std::abs(signed_volume(X)) > flat_volume(X)) usable.push_back(t);
    }
    return usable;
  }

  static std::vector<Box> boxes(const TetMesh& mesh, const std::vector<int>& tets) {
    std::vector<Box> boxes(tets.size());
    for (size_t i = 0; i < tets.size(); ++i)
      for (int v : mesh.tets[tets[i]]) boxes[i].add(mesh.rest[v]);
    return boxes;
  }

  const TetMesh& mesh_;
  std::vector<int> usable_;
  std::vector<Mat3d> inverse_;  // of the edge matrices of the usable tets
  BoxTree tree_;
};

void check_finite(const TriMesh& skin) {
  for (int v = 0; v < skin.vertex_count(); ++v) {
    const Vec3d& x = skin.vertices[v];
    if (!std::isfinite(x[0] + x[1] + x[2]))
      throw InvalidInput("skin vertex " + std::to_string(v) + " is not finite; correct the file");
  }
}

}  // namespace

Embedding embed(const TetMesh& cage_mesh, const TriMesh& skin) {
  check_finite(skin);
  const Cage cage(cage_mesh);
  Embedding embedding;
  embedding.vertices.resize(skin.vertices.size());
  embedding.weights.resize(skin.vertices.size());
  parallel_chunks(skin.vertex_count(), [&](int first, int last) {
    for (int v = first; v < last; ++v) {
      const Carrier carrier = cage.carrier(skin.vertices[v]);
      embedding.vertices[v] = cage_mesh.tets[carrier.tet];
      embedding.weights[v] = carrier.weights;
    }
  });
  for (const auto& w : embedding.weights) embedding.outside += least(w) < -kOnFace;
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
