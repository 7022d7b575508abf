#include "flat_body.h"

#include <algorithm>

#include "math/symmetric_eigen.h"
#include "triangle_tree.h"

namespace aspic {

void stretch(const Stretch& stretch, std::vector<Vec3d>& points) {
  for (Vec3d& x : points) x = x + ((stretch.factor - 1) * dot(stretch.axis, x)) * stretch.axis;
}

// The eigenvalues of sum area n n' are the areas that face each of three directions.
std::optional<Vec3d> plate_normal(const TriMesh& body) {
  constexpr double kFacing = 0.95;  // fraction of the area
  std::array<double, 9> moment{};
  double whole = 0;
  for (int t = 0; t < body.triangle_count(); ++t) {
    const Vec3d n = unit_normal(body, t);
    const double part = area(body, t);
    whole += part;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) moment[i + 3 * j] += part * n[i] * n[j];
  }
  const SymmetricEigen<3> eigen = symmetric_eigen<3>(moment);
  const auto largest = std::max_element(eigen.values.begin(), eigen.values.end());
  if (!(*largest > kFacing * whole)) return {};
  const long k = 3 * (largest - eigen.values.begin());
  return Vec3d{{eigen.vectors[k], eigen.vectors[k + 1], eigen.vectors[k + 2]}};
}

}  // namespace aspic
