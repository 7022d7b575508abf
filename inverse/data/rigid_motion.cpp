#include "data/rigid_motion.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "math/svd3.h"
#include "math/symmetric_eigen.h"

namespace aspic {

AxisAngle axis_angle_of(const Mat3d& R) {
  // The unit quaternion by its largest component, which is exact for every angle [Shepperd 1978].
  std::array<double, 4> q{};
  const double trace = R(0, 0) + R(1, 1) + R(2, 2);
  int largest = 3;
  double most = trace;
  for (int i = 0; i < 3; ++i)
    if (R(i, i) > most) most = R(i, i), largest = i;
  if (largest == 3) {
    q = {R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1), 1 + trace};
  } else {
    const int i = largest, j = (i + 1) % 3, k = (i + 2) % 3;
    q[i] = 1 + R(i, i) - R(j, j) - R(k, k);
    q[j] = R(i, j) + R(j, i);
    q[k] = R(i, k) + R(k, i);
    q[3] = R(k, j) - R(j, k);
  }
  Vec3d v = {{q[0], q[1], q[2]}};
  if (q[3] < 0) v = -1.0 * v;
  const double sine = norm(v);
  if (sine == 0) return {};
  return {(1 / sine) * v, 2 * std::atan2(sine, std::abs(q[3]))};
}

Vec3d centroid_of(std::span<const Vec3d> points) {
  Vec3d sum{};
  for (const Vec3d& p : points) sum = sum + p;
  return (1.0 / static_cast<double>(points.size())) * sum;
}

Mat3d covariance_of(std::span<const Vec3d> points) {
  const Vec3d c = centroid_of(points);
  Mat3d C{};
  for (const Vec3d& p : points)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) C(i, j) += (p[i] - c[i]) * (p[j] - c[j]) / static_cast<double>(points.size());
  return C;
}

double spread_of(std::span<const Vec3d> points) {
  const Mat3d C = covariance_of(points);
  return std::sqrt(C(0, 0) + C(1, 1) + C(2, 2));
}

Mat3d principal_axes(const Mat3d& covariance, Vec3d& variances) {
  std::array<double, 9> A{};
  std::copy(std::begin(covariance.a), std::end(covariance.a), A.begin());
  const SymmetricEigen<3> e = symmetric_eigen<3>(A);
  std::array<int, 3> order = {0, 1, 2};
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return e.values[i] > e.values[j]; });
  Mat3d axes;
  for (int k = 0; k < 2; ++k)
    for (int i = 0; i < 3; ++i) axes(i, k) = e.vectors[i + 3 * order[k]];
  const Vec3d third = cross(Vec3d{{axes(0, 0), axes(1, 0), axes(2, 0)}}, Vec3d{{axes(0, 1), axes(1, 1), axes(2, 1)}});
  for (int i = 0; i < 3; ++i) axes(i, 2) = third[i], variances[i] = std::max(e.values[order[i]], 0.0);
  return axes;
}

AffineMap best_motion(std::span<const Vec3d> points, std::span<const Vec3d> targets, bool scales, double& second) {
  const Vec3d from = centroid_of(points), to = centroid_of(targets);
  Mat3d C{};  // sum of (target - to) (point - from)'
  double spread = 0;
  for (size_t k = 0; k < points.size(); ++k) {
    const Vec3d p = points[k] - from, q = targets[k] - to;
    spread += dot(p, p);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) C(i, j) += q[i] * p[j];
  }
  const Svd3<double> svd = svd3(C);
  Mat3d R{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) R(i, j) += svd.U(i, k) * svd.V(j, k);
  second = svd.s[0] > 0 ? svd.s[1] / svd.s[0] : 0;
  const double scale = scales && spread > 0 ? (svd.s[0] + svd.s[1] + svd.s[2]) / spread : 1;
  AffineMap map;
  for (int i = 0; i < 9; ++i) map.A.a[i] = scale * R.a[i];
  map.b = to - map.A * from;
  return map;
}

double scale_of(const AffineMap& map) { return norm(Vec3d{{map.A(0, 0), map.A(1, 0), map.A(2, 0)}}); }

Mat3d rotation_of(const AffineMap& map) {
  Mat3d R = map.A;
  const double scale = scale_of(map);
  for (double& a : R.a) a /= scale;
  return R;
}

}  // namespace aspic
