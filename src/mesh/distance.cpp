#include "mesh/distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace aspic {
namespace {

constexpr double kRoundOff = std::numeric_limits<double>::epsilon();
// Squared sines of the angle between two edges. Below the first value they count as parallel. Above the second value,
// an interior solution is accurate enough to skip the comparison with the boundary.
constexpr double kParallel = 256 * kRoundOff * kRoundOff, kWellConditioned = 1e-12;

// Minimizer of |r0 + u t0 + v t1|.
struct PlaneFoot {
  bool exists = false, is_accurate = false;
  double u = 0, v = 0;
  Vec3d r = {};
};

// Applies one step of iterative refinement, which makes r orthogonal to nearly parallel t0 and t1 up to round-off.
PlaneFoot plane_foot(const Vec3d& r0, const Vec3d& t0, const Vec3d& t1) {
  const Vec3d n = cross(t0, t1);
  const double nn = squared_norm(n), scale = squared_norm(t0) * squared_norm(t1);
  PlaneFoot foot;
  foot.exists = nn > kParallel * scale;
  if (!foot.exists) return foot;
  foot.is_accurate = nn > kWellConditioned * scale;
  foot.r = r0;
  for (int pass = 0; pass < 2; ++pass) {
    foot.u -= dot(cross(foot.r, t1), n) / nn;
    foot.v -= dot(cross(t0, foot.r), n) / nn;
    foot.r = r0 + (foot.u * t0 + foot.v * t1);
  }
  return foot;
}

using Points4 = std::array<Vec3d, 4>;

void set_r(Distance& distance, const Vec3d& r) {
  distance.r = r;
  distance.d = norm(r);
}

Distance vertex_vertex(const Points4& x, int v, int w) {
  Distance distance;
  distance.point = {v, w, -1, -1};
  set_r(distance, x[v] - x[w]);
  return distance;
}

// Returns the distance of point v from edge (e0, e1).
Distance from_edge(const Points4& x, int v, int e0, int e1) {
  const Vec3d edge = x[e1] - x[e0], to_v = x[v] - x[e0];
  const double along = dot(to_v, edge), length = squared_norm(edge);
  if (!(along > 0)) return vertex_vertex(x, v, e0);
  if (!(along < length)) return vertex_vertex(x, v, e1);
  const double u = along / length;
  Distance distance;
  distance.type = DistanceType::vertex_edge;
  distance.count = 3;
  distance.point = {v, e0, e1, -1};
  distance.c = {1, u - 1, -u, 0};
  set_r(distance, to_v - u * edge);
  distance.edge[0] = x[e0] - x[e1];
  return distance;
}

void keep_nearer(Distance& nearest, const Distance& other) {
  if (other.d < nearest.d || (other.d == nearest.d && other.count < nearest.count)) nearest = other;
}

// Replaces the distance from the boundary by the interior one, unless the latter is larger because of round-off.
void keep_interior(Distance& nearest, const Distance& interior) {
  if (interior.d <= (1 + 4 * kRoundOff) * nearest.d) nearest = interior;
}

// Returns the distance from the face with the corners x[1], x[2], x[3]. Requires that its plane exists.
Distance from_face(const Points4& x, const std::array<double, 3>& weights, const Vec3d& r) {
  Distance distance;
  distance.type = DistanceType::vertex_face;
  distance.count = 4;
  distance.point = {0, 1, 2, 3};
  distance.c = {1, -weights[0], -weights[1], -weights[2]};
  set_r(distance, r);
  distance.edge = {x[1] - x[2], x[1] - x[3]};
  return distance;
}

// Returns the corner opposite to the longest side, from which the normal has the smallest error.
int widest_corner(const Points4& x) {
  const std::array<double, 3> side = {squared_norm(x[3] - x[2]), squared_norm(x[1] - x[3]), squared_norm(x[2] - x[1])};
  return static_cast<int>(std::max_element(side.begin(), side.end()) - side.begin());
}

}  // namespace

Distance point_triangle_distance(const std::array<Vec3d, 4>& x) {
  const int o = widest_corner(x), i = (o + 1) % 3, j = (o + 2) % 3;
  const PlaneFoot foot = plane_foot(x[0] - x[o + 1], x[o + 1] - x[i + 1], x[o + 1] - x[j + 1]);
  const bool is_inside = foot.exists && foot.u > 0 && foot.v > 0 && foot.u + foot.v < 1;
  Distance interior;
  if (is_inside) {
    std::array<double, 3> weights;
    weights[o] = 1 - (foot.u + foot.v);
    weights[i] = foot.u;
    weights[j] = foot.v;
    interior = from_face(x, weights, foot.r);
    if (foot.is_accurate) return interior;
  }
  Distance nearest = from_edge(x, 0, 1, 2);
  keep_nearer(nearest, from_edge(x, 0, 2, 3));
  keep_nearer(nearest, from_edge(x, 0, 3, 1));
  if (is_inside) keep_interior(nearest, interior);
  return nearest;
}

Distance edge_edge_distance(const std::array<Vec3d, 4>& x) {
  const std::array<Vec3d, 2> edge = {x[1] - x[0], x[2] - x[3]};
  const PlaneFoot foot = plane_foot(x[0] - x[2], edge[0], edge[1]);
  const bool is_inside = foot.exists && foot.u > 0 && foot.u < 1 && foot.v > 0 && foot.v < 1;
  Distance interior;
  if (is_inside) {
    interior.type = DistanceType::edge_edge;
    interior.count = 4;
    interior.point = {0, 1, 2, 3};
    interior.c = {1 - foot.u, foot.u, foot.v - 1, -foot.v};
    interior.edge = edge;
    set_r(interior, foot.r);
    if (foot.is_accurate) return interior;
  }
  Distance nearest = from_edge(x, 0, 2, 3);
  keep_nearer(nearest, from_edge(x, 1, 2, 3));
  keep_nearer(nearest, from_edge(x, 2, 0, 1));
  keep_nearer(nearest, from_edge(x, 3, 0, 1));
  if (is_inside) keep_interior(nearest, interior);
  return nearest;
}

Distance point_edge_distance(const std::array<Vec3d, 3>& x) { return from_edge({x[0], x[1], x[2], x[2]}, 0, 1, 2); }

Distance pair_distance(PairKind kind, const std::array<Vec3d, 4>& x) {
  switch (kind) {
    case PairKind::point_point:
      return vertex_vertex(x, 0, 1);
    case PairKind::point_edge:
      return from_edge(x, 0, 1, 2);
    case PairKind::point_triangle:
      return point_triangle_distance(x);
    case PairKind::edge_edge:
      return edge_edge_distance(x);
  }
  return {};
}

namespace {

using Weights = std::array<double, 4>;

double dot(const Weights& a, const Weights& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]; }

// dc/du_j
std::array<Weights, 2> weight_slopes(DistanceType type) {
  switch (type) {
    case DistanceType::vertex_vertex:
      return {};
    case DistanceType::vertex_edge:
      return {{{0, 1, -1, 0}, {}}};
    case DistanceType::vertex_face:
      return {{{0, 1, -1, 0}, {0, 1, 0, -1}}};
    case DistanceType::edge_edge:
      return {{{-1, 1, 0, 0}, {0, 0, 1, -1}}};
  }
  return {};
}

// Subtracts the components along the first `count` vectors of an orthonormal basis, twice for accuracy. Returns the
// normalized remainder.
Weights orthonormalized(Weights w, const std::array<Weights, 3>& basis, int count) {
  for (int pass = 0; pass < 2; ++pass)
    for (int i = 0; i < count; ++i) {
      const double s = dot(w, basis[i]);
      for (int k = 0; k < 4; ++k) w[k] -= s * basis[i][k];
    }
  const double scale = 1 / std::sqrt(dot(w, w));
  for (double& value : w) value *= scale;
  return w;
}

// Hessian of b(d) in the orthonormal vectors q_0 (x) n, q_1 (x) n, q_2 (x) n, q_0 (x) tau_1, q_0 (x) tau_2.
// With r = sum c_i x_i and t_j = dr/du_j = sum R_mj tau_m for orthonormal tau_m, and w_m = sum dc/du_j (R^-1)_jm:
//     Hess d = sum_{m > k} (c (x) tau_m)(c (x) tau_m)' / d
//            - sum_{m <= k} [(c (x) tau_m)(w_m (x) n)' + (w_m (x) n)(c (x) tau_m)' + d (w_m (x) n)(w_m (x) n)']
// for k = count - 2 parameters. It follows from u(x) = argmin |r| and contains no differences of large terms.
class DistanceSpace {
 public:
  explicit DistanceSpace(const Distance& distance) : distance_(distance), n_(distance.normal()) {
    tau_ = tangents(distance);
    const int parameters = distance.count - 2;
    const std::array<Weights, 2> slope = weight_slopes(distance.type);
    q_[0] = orthonormalized(distance.c, q_, 0);
    for (int j = 0; j < parameters; ++j) q_[j + 1] = orthonormalized(slope[j], q_, j + 1);
    // R is upper triangular, because tau_1 is parallel to t_1.
    std::array<Weights, 2> w = slope;
    for (int m = 0; m < parameters; ++m) {
      for (int l = 0; l < m; ++l)
        for (int k = 0; k < 4; ++k) w[m][k] -= along(l, m) * w[l][k];
      for (double& value : w[m]) value /= along(m, m);
      for (int i = 0; i <= parameters; ++i) w_[m][i] = dot(q_[i], w[m]);
    }
  }

  using Matrix = std::array<double, 25>;

  Matrix hessian(const DistanceSlopes& b) const {
    Matrix M = {};
    const double d = distance_.d, length = std::sqrt(dot(distance_.c, distance_.c));  // c = length q_0
    M[0] = b.second * length * length;
    for (int m = 0; m < 2; ++m) {
      if (m >= distance_.count - 2) {
        M[6 * (3 + m)] = b.first * length * length / d;
        continue;
      }
      for (int i = 0; i < 3; ++i) {
        M[i + 5 * (3 + m)] = M[3 + m + 5 * i] = -b.first * length * w_[m][i];
        for (int j = 0; j < 3; ++j) M[i + 5 * j] -= b.first * d * w_[m][i] * w_[m][j];
      }
    }
    return M;
  }

  DistanceHessian expand(const Matrix& M) const {
    DistanceHessian H;
    for (int i = 0; i < distance_.count; ++i)
      for (int j = 0; j <= i; ++j) H(i, j) = block(M, i, j);
    return H;
  }

 private:
  double along(int m, int j) const { return aspic::dot(tau_[m], distance_.edge[j]); }  // R_mj

  // Returns the block of points (i, j) of a matrix in the basis of the five vectors.
  Mat3d block(const Matrix& M, int i, int j) const {
    Mat3d local = {};
    for (int a = 0; a < 5; ++a)
      for (int b = 0; b < 5; ++b) {
        const int row = a < 3 ? 0 : a - 2, column = b < 3 ? 0 : b - 2;
        local(row, column) += q_[a < 3 ? a : 0][i] * M[a + 5 * b] * q_[b < 3 ? b : 0][j];
      }
    const Mat3d frame = from_columns(n_, tau_[0], tau_[1]);
    return frame * local * transpose(frame);
  }

  const Distance& distance_;
  Vec3d n_;
  std::array<Vec3d, 2> tau_;
  std::array<Weights, 3> q_ = {};
  std::array<std::array<double, 3>, 2> w_ = {};  // w_m = sum_i w_[m][i] q_i [1/m]
};

}  // namespace

DistanceHessian distance_hessian(const Distance& distance, const DistanceSlopes& b) {
  const DistanceSpace space(distance);
  return space.expand(space.hessian(b));
}

DistanceHessian filtered_distance_hessian(const Distance& distance, const DistanceSlopes& b, EigenvalueFilter filter) {
  const DistanceSpace space(distance);
  const SymmetricEigen<5> e = symmetric_eigen<5>(space.hessian(b));
  DistanceSpace::Matrix M = {};
  for (int k = 0; k < 5; ++k) {
    const double value = filter == EigenvalueFilter::absolute ? std::abs(e.values[k]) : std::max(e.values[k], 0.0);
    for (int c = 0; c < 5; ++c)
      for (int r = 0; r < 5; ++r) M[r + 5 * c] += value * e.vectors[5 * k + r] * e.vectors[5 * k + c];
  }
  return space.expand(M);
}

std::array<Vec3d, 2> tangents(const Distance& distance) {
  const Vec3d n = distance.normal();
  Vec3d along = distance.edge[0];
  if (distance.count == 2) {  // starts from the coordinate axis that is farthest from the normal
    int axis = 0;
    for (int k = 1; k < 3; ++k)
      if (std::abs(n[k]) < std::abs(n[axis])) axis = k;
    along[axis] = 1;
  }
  const Vec3d in_plane = along - dot(along, n) * n, first = (1 / norm(in_plane)) * in_plane;
  return {first, cross(n, first)};
}

}  // namespace aspic
