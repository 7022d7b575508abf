#include "model/field_basis.h"

#include <algorithm>
#include <limits>

#include "base/check.h"
#include "base/parallel.h"
#include "mesh/tet_shape.h"

namespace aspic {
namespace {

// Radius of a radial function, relative to the largest distance of a tet from the nearest center. Every tet is well
// inside the support of a function, and functions overlap. Chosen.
constexpr double kReach = 2.5;

struct Centers {
  std::vector<Vec3d> at;
  double radius = 0;  // largest distance of a point from the nearest center
};

// Farthest-point sampling, starting near the mean of all points.
Centers spread_centers(const std::vector<Vec3d>& points, int count) {
  Vec3d middle{};
  for (const Vec3d& x : points) middle = middle + (1.0 / static_cast<double>(points.size())) * x;
  const auto nearer = [&](const Vec3d& a, const Vec3d& b) { return norm(a - middle) < norm(b - middle); };
  Vec3d next = *std::min_element(points.begin(), points.end(), nearer);
  std::vector<double> distance(points.size(), std::numeric_limits<double>::infinity());
  Centers centers;
  for (int i = 0; i < count; ++i) {
    centers.at.push_back(next);
    for (size_t t = 0; t < points.size(); ++t) distance[t] = std::min(distance[t], norm(points[t] - next));
    const auto farthest = std::max_element(distance.begin(), distance.end());
    next = points[farthest - distance.begin()];
    centers.radius = *farthest;
  }
  return centers;
}

// (1 - r)^4 (4 r + 1) for r < 1
double wendland(double r) {
  const double s = std::max(0.0, 1 - r);
  return s * s * s * s * (4 * r + 1);
}

}  // namespace

FieldBasis FieldBasis::uniform(int tets) { return regions(std::vector<int>(static_cast<size_t>(tets), 0)); }

FieldBasis FieldBasis::tets(int tets) {
  FieldBasis basis;
  basis.size_ = tets;
  basis.is_identity_ = true;
  for (int t = 0; t < tets; ++t) {
    basis.index_.push_back(t);
    basis.weight_.push_back(1);
    basis.close_row();
  }
  return basis;
}

FieldBasis FieldBasis::regions(const std::vector<int>& labels) {
  std::vector<int> known = labels;
  std::sort(known.begin(), known.end());
  known.erase(std::unique(known.begin(), known.end()), known.end());
  FieldBasis basis;
  basis.size_ = static_cast<int>(known.size());
  for (int label : labels) {
    basis.index_.push_back(static_cast<int>(std::lower_bound(known.begin(), known.end(), label) - known.begin()));
    basis.weight_.push_back(1);
    basis.close_row();
  }
  return basis;
}

FieldBasis FieldBasis::radial(const TetMesh& mesh, int count) {
  ASPIC_CHECK(count >= 1 && count <= mesh.tet_count());
  std::vector<Vec3d> points;
  for (int t = 0; t < mesh.tet_count(); ++t) points.push_back(centroid(mesh, t));
  const Centers centers = spread_centers(points, count);
  if (centers.radius == 0) return tets(mesh.tet_count());
  FieldBasis basis;
  basis.size_ = count;
  for (const Vec3d& x : points) {
    const size_t begin = basis.weight_.size();
    double sum = 0;
    for (int j = 0; j < count; ++j) {
      const double w = wendland(norm(x - centers.at[j]) / (kReach * centers.radius));
      if (w == 0) continue;
      basis.index_.push_back(j);
      basis.weight_.push_back(w);
      sum += w;
    }
    for (size_t s = begin; s < basis.weight_.size(); ++s) basis.weight_[s] /= sum;
    basis.close_row();
  }
  basis.centers_ = centers.at;
  return basis;
}

void FieldBasis::multiply(std::span<const double> p, std::span<double> z) const {
  ASPIC_CHECK(static_cast<int>(p.size()) == size_ && static_cast<int>(z.size()) == tet_count());
  parallel_chunks(tet_count(), [&](int first, int last) {
    for (int t = first; t < last; ++t) {
      z[t] = 0;
      for (int s = row_start_[t]; s < row_start_[t + 1]; ++s) z[t] += weight_[s] * p[index_[s]];
    }
  });
}

void FieldBasis::add_transposed(std::span<const double> z, std::span<double> p) const {
  ASPIC_CHECK(static_cast<int>(p.size()) == size_ && static_cast<int>(z.size()) == tet_count());
  for_each_weight([&](int t, int j, double w) { p[j] += w * z[t]; });
}

}  // namespace aspic
