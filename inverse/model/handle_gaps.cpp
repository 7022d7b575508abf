#include "model/handle_gaps.h"

#include <cmath>

#include "mesh/tet_shape.h"

namespace aspic {
namespace {

// Correlation length, relative to the cube root of the volume. Two layers with 8 handles: 93 % of the intervals contain
// the truth (docs/fitting.md).
constexpr double kCorrelation = 0.5;

double correlation_length(const TetMesh& mesh) {
  double all = 0;
  for (int t = 0; t < mesh.tet_count(); ++t) all += volume(mesh, t);
  return kCorrelation * std::cbrt(all);
}

}  // namespace

std::vector<double> handle_gaps(const TetMesh& mesh, const FieldBasis& basis) {
  if (basis.centers().empty()) return {};
  const std::vector<Vec3d>& centers = basis.centers();
  const double length = correlation_length(mesh);
  const auto correlation = [&](const Vec3d& a, const Vec3d& b) { return std::exp(-norm(a - b) / length); };
  struct Weight {
    int center;
    double w;
  };
  std::vector<std::vector<Weight>> of_tet(mesh.tets.size());
  basis.for_each_weight([&](int t, int j, double w) { of_tet[t].push_back({j, w}); });
  std::vector<double> gaps;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const Vec3d x = centroid(mesh, t);
    double gap = 1;  // 1 - 2 sum_j w_j rho(x, c_j) + sum_ij w_i w_j rho(c_i, c_j)
    for (const Weight& a : of_tet[t]) {
      gap -= 2 * a.w * correlation(x, centers[a.center]);
      for (const Weight& b : of_tet[t]) gap += a.w * b.w * correlation(centers[a.center], centers[b.center]);
    }
    gaps.push_back(std::max(gap, 0.0));
  }
  return gaps;
}

}  // namespace aspic
