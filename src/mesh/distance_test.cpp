#include "mesh/distance.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "math/dual.h"
#include "mesh/triangle_shape.h"

namespace aspic {
namespace {

using Points = std::array<Vec3d, 4>;
using Matrix12 = Eigen::Matrix<double, 12, 12>;
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

Points random_points(std::mt19937& random) {
  std::normal_distribution<double> normal;
  Points x;
  for (Vec3d& p : x)
    for (double& value : p.a) value = normal(random);
  return x;
}

Vec3d weighted_sum(const Distance& distance, const Points& x) {
  Vec3d sum = {};
  for (int i = 0; i < distance.count; ++i) sum = sum + distance.c[i] * x[distance.point[i]];
  return sum;
}

// Checks properties of every result: r is the weighted difference of points of both primitives.
void expect_consistent(const Distance& distance, const Points& x, double tolerance) {
  const auto& c = distance.c;
  EXPECT_LE(norm(weighted_sum(distance, x) - distance.r), tolerance);
  EXPECT_DOUBLE_EQ(distance.d, norm(distance.r));
  EXPECT_NEAR(c[0] + c[1] + c[2] + c[3], 0, 4 * kEpsilon);
  const bool are_edges = distance.type == DistanceType::edge_edge;
  for (int i = 0; i < distance.count; ++i) EXPECT_GE(c[i] * (i < (are_edges ? 2 : 1) ? 1 : -1), 0);
}

// Minimizes the distance of a(s) from edge b over s by ternary search; it is convex.
double edge_distance_by_search(const Points& x) {
  const auto at = [&](double s) { return point_edge_distance({x[0] + s * (x[1] - x[0]), x[2], x[3]}).d; };
  double low = 0, high = 1;
  for (int i = 0; i < 200; ++i) {
    const double s = low + (high - low) / 3, t = high - (high - low) / 3;
    if (at(s) < at(t)) {
      high = t;
    } else {
      low = s;
    }
  }
  return std::min({at(low), at(0), at(1)});
}

TEST(PointTriangleDistance, AgreesWithWalkThroughVoronoiRegions) {
  std::mt19937 random(1);
  std::array<int, 4> seen = {};
  for (int trial = 0; trial < 20000; ++trial) {
    const Points x = random_points(random);
    const Distance distance = point_triangle_distance(x);
    const Vec3d r = x[0] - nearest_point(x[0], x[1], x[2], x[3]);
    ASSERT_LE(norm(distance.r - r), 1e-12 * (1 + norm(r)));
    expect_consistent(distance, x, 1e-14 * 8);
    ++seen[static_cast<int>(distance.type)];
  }
  EXPECT_GT(seen[0], 50);
  EXPECT_GT(seen[1], 50);
  EXPECT_GT(seen[2], 50);
}

TEST(EdgeEdgeDistance, AgreesWithSearch) {
  std::mt19937 random(2);
  std::array<int, 4> seen = {};
  for (int trial = 0; trial < 1000; ++trial) {
    const Points x = random_points(random);
    const Distance distance = edge_edge_distance(x);
    ASSERT_NEAR(distance.d, edge_distance_by_search(x), 1e-12);
    expect_consistent(distance, x, 1e-14 * 8);
    ++seen[static_cast<int>(distance.type)];
  }
  EXPECT_GT(seen[0], 50);
  EXPECT_GT(seen[1], 50);
  EXPECT_GT(seen[3], 50);
}

TEST(EdgeEdgeDistance, IsAccurateForNearlyParallelEdges) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (double angle = 1; angle > 1e-20; angle /= 3)
    for (int trial = 0; trial < 20; ++trial) {
      Points x = random_points(random);
      const double shift = normal(random);
      for (int k = 0; k < 3; ++k) {
        const double along = x[1][k] - x[0][k];
        x[2][k] = x[0][k] + shift * along + 1e-3 * normal(random);
        x[3][k] = x[2][k] + along + angle * normal(random);
      }
      const Distance distance = edge_edge_distance(x);
      ASSERT_NEAR(distance.d, edge_distance_by_search(x), 1e-14 * 8) << angle;
      expect_consistent(distance, x, 1e-14);
    }
}

// The height of the triangle vanishes; its exact distance from the plane is known.
TEST(PointTriangleDistance, KeepsAccuracyInSlivers) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(0.1, 0.9);
  for (double height = 1; height > 1e-20; height /= 4)
    for (int trial = 0; trial < 20; ++trial) {
      const double z = std::exp(-10 * uniform(random)), top = uniform(random);
      Points x = {{{{0, 0, z}}, {{0, 0, 0}}, {{1, 0, 0}}, {{top, height, 0}}}};
      const double v = uniform(random), u = (1 - v) * uniform(random);
      x[0][0] = u + v * top;
      x[0][1] = v * height;
      std::rotate(x.begin() + 1, x.begin() + 1 + trial % 3, x.end());
      const Distance distance = point_triangle_distance(x);
      ASSERT_NEAR(distance.d, z, 2 * kEpsilon) << height;
      expect_consistent(distance, x, 4 * kEpsilon);
    }
}

TEST(Distances, AreFiniteForDegeneratePrimitives) {
  const Vec3d a = {{0, 0, 0}}, b = {{1, 0, 0}}, c = {{2, 0, 0}}, p = {{1.5, 2, 0}};
  EXPECT_EQ(point_triangle_distance({p, a, a, a}).d, 2.5);
  EXPECT_EQ(point_triangle_distance({p, a, a, a}).type, DistanceType::vertex_vertex);
  EXPECT_EQ(point_triangle_distance({p, a, b, c}).d, 2);
  EXPECT_EQ(point_triangle_distance({p, a, c, c}).type, DistanceType::vertex_edge);
  EXPECT_EQ(edge_edge_distance({p, p, a, a}).d, 2.5);
  EXPECT_EQ(edge_edge_distance({p, p, a, c}).d, 2);
  EXPECT_EQ(edge_edge_distance({a, b, b, c}).d, 0);
  EXPECT_EQ(edge_edge_distance({a, c, a, c}).d, 0);
  EXPECT_EQ(edge_edge_distance({a, c, b, c}).d, 0);
  EXPECT_EQ(point_triangle_distance({a, a, a, a}).d, 0);
  EXPECT_EQ(point_edge_distance({p, a, a}).d, 2.5);
}

TEST(Distances, UseFewestPointsForTouchingFeatures) {
  const Vec3d a = {{0, 0, 0}}, b = {{1, 0, 0}}, c = {{0, 1, 0}}, above = {{0, 0, 1}};
  EXPECT_EQ(point_triangle_distance({above, a, b, c}).type, DistanceType::vertex_vertex);
  EXPECT_EQ(point_triangle_distance({Vec3d{{0.5, 0, 1}}, a, b, c}).type, DistanceType::vertex_edge);
  EXPECT_EQ(point_triangle_distance({Vec3d{{0.25, 0.25, 1}}, a, b, c}).type, DistanceType::vertex_face);
  EXPECT_EQ(edge_edge_distance({a, b, above, above + c}).type, DistanceType::vertex_vertex);
  EXPECT_EQ(edge_edge_distance({a, b, above, above + b}).type, DistanceType::vertex_vertex);
  EXPECT_EQ(edge_edge_distance({a, b, {{0.5, 0, 1}}, {{0.5, 2, 1}}}).type, DistanceType::vertex_edge);
  EXPECT_EQ(edge_edge_distance({a, b, {{0.5, -1, 1}}, {{0.5, 2, 1}}}).type, DistanceType::edge_edge);
}

TEST(Distances, ScaleExactlyAndTolerateTranslation) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 1000; ++trial) {
    const Points x = random_points(random);
    Points scaled = x, rounded = x, moved = x;
    const Vec3d far = {{0x1p20, -0x1p20, 0x1p19}};
    for (int i = 0; i < 4; ++i) {
      scaled[i] = 0x1p-10 * x[i];
      moved[i] = x[i] + far;
      rounded[i] = moved[i] - far;  // exact
    }
    for (const auto& distance_of : {point_triangle_distance, edge_edge_distance}) {
      ASSERT_EQ(distance_of(scaled).d, 0x1p-10 * distance_of(x).d);
      ASSERT_EQ(distance_of(moved).d, distance_of(rounded).d);
      ASSERT_EQ(distance_of(moved).c, distance_of(rounded).c);
    }
  }
}

using Second = Dual<Dual<double>>;
using SecondPoints = std::array<Vec3<Second>, 4>;

// Returns the distance between the lines and planes of a stencil, from textbook formulas.
Second distance_formula(DistanceType type, const SecondPoints& x) {
  const auto length = [](const Vec3<Second>& v) { return sqrt(dot(v, v)); };
  switch (type) {
    case DistanceType::vertex_vertex:
      return length(x[0] - x[1]);
    case DistanceType::vertex_edge:
      return length(cross(x[2] - x[1], x[0] - x[1])) / length(x[2] - x[1]);
    case DistanceType::vertex_face: {
      const Vec3<Second> n = cross(x[2] - x[1], x[3] - x[1]);
      return abs(dot(n, x[0] - x[1])) / length(n);
    }
    default: {
      const Vec3<Second> n = cross(x[1] - x[0], x[3] - x[2]);
      return abs(dot(n, x[0] - x[2])) / length(n);
    }
  }
}

// b(d) = -ln(d)
Second barrier_formula(DistanceType type, const SecondPoints& x) { return -log(distance_formula(type, x)); }
DistanceSlopes barrier_slopes(double d) { return {-1 / d, 1 / (d * d)}; }

// Returns the second derivative with respect to coordinates i and j of the stencil points.
double second_derivative(const Distance& distance, const Points& x, int i, int j) {
  SecondPoints y;
  for (int k = 0; k < distance.count; ++k)
    for (int axis = 0; axis < 3; ++axis) {
      const Dual<double> value(x[distance.point[k]][axis], 3 * k + axis == i ? 1.0 : 0.0);
      y[k][axis] = Second(value, Dual<double>(3 * k + axis == j ? 1.0 : 0.0));
    }
  return barrier_formula(distance.type, y).rate.rate;
}

Matrix12 dense(const DistanceHessian& H) {
  Matrix12 D;
  for (int r = 0; r < 12; ++r)
    for (int c = 0; c < 12; ++c)
      D(r, c) = r / 3 >= c / 3 ? H(r / 3, c / 3)(r % 3, c % 3) : H(c / 3, r / 3)(c % 3, r % 3);
  return D;
}

Matrix12 hessian_by_autodiff(const Distance& distance, const Points& x) {
  Matrix12 D = Matrix12::Zero();
  for (int i = 0; i < 3 * distance.count; ++i)
    for (int j = 0; j < 3 * distance.count; ++j) D(i, j) = second_derivative(distance, x, i, j);
  return D;
}

// Calls check(distance, x) for random pairs of both kinds: far, near and almost touching.
template <class Check>
void for_each_pair(int trials, Check check) {
  std::mt19937 random(6);
  for (int trial = 0; trial < trials; ++trial)
    for (const auto& distance_of : {point_triangle_distance, edge_edge_distance}) {
      Points x = random_points(random);
      const Distance before = distance_of(x);
      const double factor = std::pow(0.1, trial % 4);  // moves the first feature toward the second one
      const int moved = before.type == DistanceType::edge_edge ? 2 : 1;
      for (int i = 0; i < moved; ++i) x[before.point[i]] = x[before.point[i]] - (1 - factor) * before.r;
      check(distance_of(x), x);
    }
}

TEST(DistanceHessian, AgreesWithAutomaticDifferentiation) {
  std::array<int, 4> seen = {};
  for_each_pair(400, [&](const Distance& distance, const Points& x) {
    const Matrix12 exact = hessian_by_autodiff(distance, x);
    const Matrix12 H = dense(distance_hessian(distance, barrier_slopes(distance.d)));
    // The reference formulas lose digits for nearly parallel edges.
    ASSERT_LT((H - exact).norm(), 1e-9 * exact.norm());
    ++seen[static_cast<int>(distance.type)];
  });
  EXPECT_GT(*std::min_element(seen.begin(), seen.end()), 20);
}

TEST(DistanceHessian, HasGradientFromWeightsAndNormal) {
  for_each_pair(100, [](const Distance& distance, const Points& x) {
    for (int i = 0; i < 3 * distance.count; ++i) {
      SecondPoints y;
      for (int k = 0; k < distance.count; ++k)
        for (int axis = 0; axis < 3; ++axis)
          y[k][axis] = Second(Dual<double>(x[distance.point[k]][axis], 3 * k + axis == i ? 1.0 : 0.0));
      ASSERT_NEAR(distance.c[i / 3] * distance.normal()[i % 3], distance_formula(distance.type, y).value.rate, 1e-9);
    }
  });
}

// Returns the dense matrix with clamped or absolute eigenvalues.
Matrix12 filtered(const Matrix12& H, EigenvalueFilter filter) {
  const Eigen::SelfAdjointEigenSolver<Matrix12> eigen(H);
  const Eigen::Matrix<double, 12, 1> values = eigen.eigenvalues();
  const auto chosen = filter == EigenvalueFilter::absolute ? values.cwiseAbs().eval() : values.cwiseMax(0).eval();
  return eigen.eigenvectors() * chosen.asDiagonal() * eigen.eigenvectors().transpose();
}

TEST(DistanceHessian, IsFilteredExactlyInFiveDimensions) {
  for_each_pair(200, [](const Distance& distance, const Points&) {
    const DistanceSlopes b = barrier_slopes(distance.d);
    const Matrix12 H = dense(distance_hessian(distance, b));
    for (const EigenvalueFilter filter : {EigenvalueFilter::clamp, EigenvalueFilter::absolute})
      ASSERT_LT((dense(filtered_distance_hessian(distance, b, filter)) - filtered(H, filter)).norm(), 1e-13 * H.norm());
  });
}

TEST(DistanceHessian, AnnihilatesTranslations) {
  for_each_pair(100, [](const Distance& distance, const Points&) {
    const Matrix12 H = dense(distance_hessian(distance, barrier_slopes(distance.d)));
    Eigen::Matrix<double, 12, 3> translations;
    for (int i = 0; i < 12; ++i)
      for (int k = 0; k < 3; ++k) translations(i, k) = i % 3 == k ? 1 : 0;
    ASSERT_LT((H * translations).norm(), 1e-13 * H.norm());
  });
}

TEST(Tangents, AreOrthonormalAndOrthogonalToNormal) {
  for_each_pair(100, [](const Distance& distance, const Points&) {
    const auto [s, t] = tangents(distance);
    const Vec3d n = distance.normal();
    EXPECT_NEAR(norm(s), 1, 1e-15 * 8);
    EXPECT_NEAR(norm(t), 1, 1e-15 * 8);
    EXPECT_NEAR(dot(s, t), 0, 1e-15 * 8);
    EXPECT_NEAR(dot(s, n), 0, 1e-15 * 8);
    EXPECT_NEAR(dot(t, n), 0, 1e-15 * 8);
  });
}

}  // namespace
}  // namespace aspic
