#include <algorithm>
#include <limits>

#include "mesh/box_tree.h"
#include "mesh/components.h"
#include "mesh/doctor.h"
#include "mesh/tet_shape.h"

namespace aspic {

MeshQuality quality(const TetMesh& mesh) {
  constexpr int kBins = 10;
  MeshQuality q;
  q.mean_ratio_histogram.assign(kBins, 0);
  if (mesh.tets.empty()) return q;
  Box box;
  for (const Vec3d& x : mesh.rest) box.add(x);
  q.lower = box.lower, q.upper = box.upper;
  q.components = static_cast<int>(tet_components(mesh).size());
  q.min_volume = q.min_mean_ratio = std::numeric_limits<double>::infinity();
  q.max_volume = -q.min_volume;
  q.min_dihedral = 180;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const TetCorners X = corners(mesh, t);
    const double volume = signed_volume(X), ratio = mean_ratio(X);
    const auto [least, most] = dihedral_range(X);
    q.min_volume = std::min(q.min_volume, volume);
    q.max_volume = std::max(q.max_volume, volume);
    q.total_volume += volume;
    q.min_dihedral = std::min(q.min_dihedral, least);
    q.max_dihedral = std::max(q.max_dihedral, most);
    q.min_mean_ratio = std::min(q.min_mean_ratio, ratio);
    q.average_mean_ratio += ratio / mesh.tet_count();
    // Inverted tets count in the lowest bin. An overflowed ratio is bounded before it becomes an index.
    ++q.mean_ratio_histogram[ratio > 0 ? std::min(kBins - 1, static_cast<int>(std::min(ratio, 1.0) * kBins)) : 0];
  }
  return q;
}

}  // namespace aspic
