#include "mesh/locate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "mesh/tet_shape.h"

namespace aspic {
namespace {

// Relative tolerance of equal distances: an outside point is often nearest to an edge or corner that several tets
// share.
constexpr double kTie = 1e-9;
// Points with weights down to -kOnFace count as on the face.
constexpr double kOnFace = 1e-9;

std::vector<int> usable_tets(const TetMesh& mesh) {
  std::vector<int> usable;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const TetCorners X = corners(mesh, t);
    if (std::abs(signed_volume(X)) > flat_volume(X)) usable.push_back(t);
  }
  return usable;
}

std::vector<Box> boxes(const TetMesh& mesh, const std::vector<int>& tets) {
  std::vector<Box> boxes(tets.size());
  for (size_t i = 0; i < tets.size(); ++i)
    for (int v : mesh.tets[tets[i]]) boxes[i].add(mesh.rest[v]);
  return boxes;
}

}  // namespace

double Located::min_weight() const { return *std::min_element(weights.begin(), weights.end()); }
bool Located::is_outside() const { return min_weight() < -kOnFace; }

TetLocator::TetLocator(const TetMesh& mesh) : mesh_(mesh), usable_(usable_tets(mesh)), tree_(boxes(mesh, usable_)) {
  if (usable_.empty()) throw InvalidInput("the mesh has no tets of positive volume; repair or remesh it");
  for (int tet : usable_) inverse_.push_back(inverse(edge_matrix(mesh, tet)));
}

Located TetLocator::locate(const Vec3d& p) const {
  const Located containing = container(p);
  return containing.tet >= 0 ? containing : nearest(p);
}

Located TetLocator::container(const Vec3d& p) const {
  Located best;
  double deepest = -kOnFace;
  constexpr double kHere = 0;
  tree_.for_each_near(p, kHere, [&](int item) {
    const Located here{usable_[item], weights(item, p), 0};
    if (here.min_weight() < deepest) return;
    deepest = here.min_weight();
    best = here;
  });
  return best;
}

Located TetLocator::nearest(const Vec3d& p) const {
  Located best;
  best.squared_distance = std::numeric_limits<double>::infinity();
  double reach = std::numeric_limits<double>::infinity();
  tree_.for_each_near(p, reach, [&](int item) {
    Located here{usable_[item], weights(item, p), 0};
    here.squared_distance = squared_distance(corners(mesh_, usable_[item]), here.weights, p);
    if (here.squared_distance > reach) return;
    const bool is_nearer = here.squared_distance < best.squared_distance * (1 - kTie);
    if (best.tet >= 0 && !is_nearer && here.min_weight() <= best.min_weight()) return;
    best = here;
    reach = std::min(reach, here.squared_distance * (1 + kTie));
  });
  return best;
}

std::array<double, 4> TetLocator::weights(int item, const Vec3d& p) const {
  const Vec3d w = inverse_[item] * (p - mesh_.rest[mesh_.tets[usable_[item]][0]]);
  return {1 - w[0] - w[1] - w[2], w[0], w[1], w[2]};
}

}  // namespace aspic
