#include "model/local_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/check.h"
#include "base/parallel.h"

namespace aspic {
namespace {

// Tree of points for queries: nodes split the longest side of their box at the median, down to leaves of a few points.
class PointTree {
 public:
  explicit PointTree(std::span<const Vec3d> points) : points_(points), order_(points.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    build(0, static_cast<int>(points.size()));
  }

  std::span<const int> order() const { return order_; }

  MotionNeighbors nearest(int of) const {
    Query query{points_[of], of};
    query.found.fill({std::numeric_limits<double>::infinity(), -1});
    search(0, query);
    MotionNeighbors result{};
    for (int k = 0; k < kMotionNeighbors; ++k) result[k] = query.found[k].second;
    return result;
  }

 private:
  static constexpr int kLeaf = 8;  // points; the result does not depend on it
  struct Node {
    int begin, end, right = -1;  // right < 0: a leaf; the left child follows its parent
    int axis = 0;
    double split = 0;
  };
  struct Query {
    Vec3d x;
    int self;
    std::array<std::pair<double, int>, kMotionNeighbors> found{};  // squared distance, index
    double reach() const { return found.back().first; }
    void add(const std::pair<double, int>& candidate) {
      if (!(candidate < found.back())) return;
      int k = kMotionNeighbors - 1;
      for (; k > 0 && candidate < found[k - 1]; --k) found[k] = found[k - 1];
      found[k] = candidate;
    }
  };

  void build(int begin, int end) {
    const int index = static_cast<int>(nodes_.size());
    nodes_.push_back({begin, end});
    if (end - begin <= kLeaf) return;
    Vec3d lower = points_[order_[begin]], upper = lower;
    for (int k = begin; k < end; ++k)
      for (int i = 0; i < 3; ++i) {
        lower[i] = std::min(lower[i], points_[order_[k]][i]);
        upper[i] = std::max(upper[i], points_[order_[k]][i]);
      }
    int axis = 0;
    for (int i = 1; i < 3; ++i)
      if (upper[i] - lower[i] > upper[axis] - lower[axis]) axis = i;
    const int middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](int a, int b) { return std::pair(points_[a][axis], a) < std::pair(points_[b][axis], b); });
    nodes_[index].axis = axis;
    nodes_[index].split = points_[order_[middle]][axis];
    build(begin, middle);
    nodes_[index].right = static_cast<int>(nodes_.size());
    build(middle, end);
  }

  void search(int index, Query& query) const {
    const Node& node = nodes_[index];
    if (node.right < 0) {
      for (int k = node.begin; k < node.end; ++k) {
        const int j = order_[k];
        if (j != query.self) query.add({squared_norm(points_[j] - query.x), j});
      }
      return;
    }
    const double beyond = query.x[node.axis] - node.split;
    const bool is_right = beyond >= 0;
    search(is_right ? node.right : index + 1, query);
    if (beyond * beyond <= query.reach()) search(is_right ? index + 1 : node.right, query);
  }

  std::span<const Vec3d> points_;
  std::vector<int> order_;
  std::vector<Node> nodes_;
};

using Row4 = std::array<double, 4>;
using PerNeighbor = std::array<double, kMotionNeighbors>;

// Solves the symmetric positive definite A c = b for three right-hand sides; the upper triangle of A is given.
std::array<Vec3d, 4> solve(std::array<Row4, 4> A, std::array<Vec3d, 4> b) {
  for (int k = 0; k < 4; ++k)
    for (int i = k + 1; i < 4; ++i) {
      const double l = A[k][i] / A[k][k];
      for (int j = i; j < 4; ++j) A[i][j] -= l * A[k][j];
      b[i] = b[i] - l * b[k];
    }
  for (int k = 3; k >= 0; --k) {
    for (int j = k + 1; j < 4; ++j) b[k] = b[k] - A[k][j] * b[j];
    b[k] = (1 / A[k][k]) * b[k];
  }
  return b;
}

double middle_of(PerNeighbor values) {
  constexpr int kHalf = kMotionNeighbors / 2;
  static_assert(kMotionNeighbors % 2 == 0);
  std::nth_element(values.begin(), values.begin() + kHalf, values.end());
  return (values[kHalf] + *std::max_element(values.begin(), values.begin() + kHalf)) / 2;
}

// Weighted least squares for u = c[0] + c[1] t[1] + c[2] t[2] + c[3] t[3].
std::array<Vec3d, 4> field(std::span<const Row4> terms, std::span<const Vec3d> motion, const PerNeighbor& weight) {
  constexpr double kSlopeRidge = 1e-3;  // beside sums over 12 neighbors; coplanar ones have no normal slope
  std::array<Row4, 4> A{};
  std::array<Vec3d, 4> b{};
  for (int k = 1; k < 4; ++k) A[k][k] = kSlopeRidge;
  for (int n = 0; n < kMotionNeighbors; ++n)
    for (int k = 0; k < 4; ++k) {
      const double scaled = weight[n] * terms[n][k];
      for (int l = k; l < 4; ++l) A[k][l] += scaled * terms[n][l];
      b[k] = b[k] + scaled * motion[n];
    }
  return solve(A, b);
}

}  // namespace

std::vector<MotionNeighbors> nearest_points(std::span<const Vec3d> points) {
  ASPIC_CHECK(points.size() > kMotionNeighbors);
  const PointTree tree(points);
  std::vector<MotionNeighbors> nearest(points.size());
  parallel_chunks(static_cast<int>(points.size()), [&](int first, int last) {
    for (int k = first; k < last; ++k) nearest[tree.order()[k]] = tree.nearest(tree.order()[k]);
  });
  return nearest;
}

ExpectedMotion expected_motion(std::span<const Vec3d> X, std::span<const Vec3d> u, int i, const MotionNeighbors& near) {
  constexpr int kSweeps = 8;  // chosen
  const double reach = norm(X[near.back()] - X[i]), scale = reach > 0 ? 1 / reach : 0;
  std::array<Row4, kMotionNeighbors> terms;
  std::array<Vec3d, kMotionNeighbors> motion;
  for (int n = 0; n < kMotionNeighbors; ++n) {
    const Vec3d r = scale * (X[near[n]] - X[i]);
    terms[n] = {1, r[0], r[1], r[2]};
    motion[n] = u[near[n]];
  }
  PerNeighbor weight, difference, range;
  weight.fill(1);
  std::array<Vec3d, 4> c{};
  double typical = 0;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    c = field(terms, motion, weight);
    for (int n = 0; n < kMotionNeighbors; ++n) {
      const Row4& t = terms[n];
      difference[n] = norm(motion[n] - (c[0] + t[1] * c[1] + t[2] * c[2] + t[3] * c[3]));
    }
    typical = middle_of(difference);
    for (int n = 0; n < kMotionNeighbors; ++n) weight[n] = typical > 0 ? typical / std::max(difference[n], typical) : 1;
  }
  for (int n = 0; n < kMotionNeighbors; ++n) range[n] = norm(motion[n] - c[0]);
  return {c[0], typical, middle_of(range)};
}

}  // namespace aspic
