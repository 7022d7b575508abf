#include "linalg/gauss_seidel.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <limits>

#include "base/parallel.h"
#include "linalg/graph.h"
#include "linalg/matrices_test.h"

namespace aspic {
namespace {

using namespace test;
using Dense = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

// Returns a matrix on a random graph with four rows per vertex, or one.
Matrix vertex_matrix(int vertices, int rows_per_vertex, unsigned seed) {
  const int B = rows_per_vertex;
  Couplings couplings;
  for (int v = 0; v < vertices; ++v)
    for (int k = 0; k < B * B; ++k) couplings.emplace_back(B * v + k / B, B * v + k % B);
  for (const auto& [v, w] : random_couplings(vertices, 2 * vertices, seed))
    for (int k = 0; k < B * B; ++k) couplings.emplace_back(B * v + k / B, B * w + k % B);
  return random_dominant(B * vertices, couplings, seed);
}

struct Groups {
  std::vector<int> of_vertex, color;
};

// Groups consecutive vertices, except those in `excluded`.
Groups make_groups(const Graph& vertices, int size, const std::vector<int>& excluded = {}) {
  Groups groups;
  const int count = (vertices.vertex_count() + size - 1) / size;
  for (int v = 0; v < vertices.vertex_count(); ++v) groups.of_vertex.push_back(v / size);
  for (const int v : excluded) groups.of_vertex[v] = -1;
  groups.color = greedy_coloring(quotient(vertices, groups.of_vertex, count));
  return groups;
}

Graph graph_of_vertices(const BlockPattern& p, int rows_per_vertex) {
  std::vector<int> vertex(p.rows());
  for (int row = 0; row < p.rows(); ++row) vertex[row] = row / rows_per_vertex;
  return quotient(graph_of(p), vertex, p.rows() / rows_per_vertex);
}

// Converts vectors between the order of the rows and that of the smoother.
struct Layout {
  const GaussSeidel& smoother;
  size_t place(int k, int m) const {
    return static_cast<size_t>(kFloatsPerRow * smoother.rows_per_vertex() * k + 3 * m);
  }
  int row(int k, int m) const { return smoother.rows_per_vertex() * smoother.order()[k] + m; }

  template <class Visit>
  void for_each(const Visit& visit) const {
    for (size_t k = 0; k < smoother.order().size(); ++k)
      for (int m = 0; m < smoother.rows_per_vertex(); ++m)
        for (int i = 0; i < 3; ++i) visit(place(static_cast<int>(k), m) + i, 3 * row(static_cast<int>(k), m) + i);
  }
  std::vector<float> to_floats(const Vector& x) const {
    std::vector<float> floats(kFloatsPerRow * static_cast<size_t>(smoother.rows()),
                              1e30F);  // unused lanes do not matter
    for_each([&](size_t to, int from) { floats[to] = static_cast<float>(x[from]); });
    return floats;
  }
  Vector to_vector(const std::vector<float>& floats) const {
    Vector x(3 * smoother.rows());
    for_each([&](size_t from, int to) { x[to] = floats[from]; });
    return x;
  }
};

// H = L + D + U in the order of the visit; D contains the blocks of whole vertices.
struct Split {
  Dense L, D, U;
  Split(const BlockSparse& H, const GaussSeidel& smoother) {
    const std::vector<double> entries = dense(H);
    const int n = 3 * H.pattern->rows(), width = 3 * smoother.rows_per_vertex();
    const Eigen::Map<const Dense> A(entries.data(), n, n);
    std::vector<int> visit(smoother.order().size());
    for (size_t k = 0; k < visit.size(); ++k) visit[smoother.order()[k]] = static_cast<int>(k);
    L = D = U = Dense::Zero(n, n);
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const int a = visit[i / width], b = visit[j / width];
        (a > b ? L : a < b ? U : D)(i, j) = A(i, j);
      }
  }
};

double largest(const Vector& v) { return v.cwiseAbs().maxCoeff(); }

// The matrices are diagonally dominant, so solving for a vertex does not amplify errors. A row adds one random error
// per entry, fewer than 200.
constexpr double kBound = 20 * std::numeric_limits<float>::epsilon();

void expect_sweeps(const BlockSparse& H, const GaussSeidel& smoother, unsigned seed) {
  const int n = 3 * H.pattern->rows();
  const Layout layout{smoother};
  const Split split(H, smoother);
  const std::vector<double> random = random_vector(2 * static_cast<size_t>(n), seed);
  const Vector b = Eigen::Map<const Vector>(random.data(), n), x = Eigen::Map<const Vector>(&random[n], n);
  const std::vector<float> bf = layout.to_floats(b);
  std::vector<float> xf(bf.size(), std::numeric_limits<float>::quiet_NaN()), rf = xf, yf = xf;  // overwritten

  smoother.sweep_forward(bf.data(), xf.data());
  const Vector forward = (split.L + split.D).partialPivLu().solve(b);
  EXPECT_LT(largest(layout.to_vector(xf) - forward), kBound * largest(forward));
  smoother.residual_after_forward(xf.data(), rf.data());
  EXPECT_LT(largest(layout.to_vector(rf) - (b - (split.L + split.D + split.U) * forward)), kBound * largest(b));

  std::vector<float> backward = layout.to_floats(x), before = backward;
  smoother.sweep_backward(bf.data(), backward.data());
  const Vector expected = (split.D + split.U).partialPivLu().solve(b - split.L * x);
  EXPECT_LT(largest(layout.to_vector(backward) - expected), kBound * largest(expected));

  smoother.multiply_after_backward(bf.data(), before.data(), backward.data(), yf.data());
  const Vector product = (split.L + split.D + split.U) * expected;
  EXPECT_LT(largest(layout.to_vector(yf) - product), kBound * largest(product));
}

TEST(GaussSeidel, SweepsMatchDenseMatrix) {
  for (const int rows_per_vertex : {1, 4})
    for (const int vertices : {1, 2, 7, 60})
      for (const int size : {1, 5}) {
        const Matrix H = vertex_matrix(vertices, rows_per_vertex, 3);
        const Groups groups = make_groups(graph_of_vertices(*H.pattern, rows_per_vertex), size);
        GaussSeidel smoother;
        smoother.analyze(*H.pattern, rows_per_vertex, groups.of_vertex, groups.color);
        ASSERT_TRUE(smoother.load(H.values));
        SCOPED_TRACE(testing::Message() << vertices << " vertices of " << rows_per_vertex << " rows by " << size);
        expect_sweeps(H.values, smoother, 4);
      }
}

TEST(GaussSeidel, VisitsUngroupedVerticesLast) {
  Matrix H = vertex_matrix(40, 1, 5);
  const std::vector<int> pinned = {0, 17, 18, 39};
  for (const int row : pinned) pin(H.values, row);
  const Groups groups = make_groups(graph_of(*H.pattern), 6, pinned);
  GaussSeidel smoother;
  smoother.analyze(*H.pattern, 1, groups.of_vertex, groups.color);
  ASSERT_TRUE(smoother.load(H.values));
  EXPECT_EQ(std::vector(smoother.order().end() - 4, smoother.order().end()), pinned);
  expect_sweeps(H.values, smoother, 6);

  const std::vector<int> none(40, -1);  // no groups at all
  smoother.analyze(*H.pattern, 1, none, {});
  ASSERT_TRUE(smoother.load(H.values));
  expect_sweeps(H.values, smoother, 7);
}

TEST(GaussSeidel, VisitsEachVertexOnceGroupByGroup) {
  const Matrix H = vertex_matrix(50, 1, 8);
  const Graph graph = graph_of(*H.pattern);
  const Groups groups = make_groups(graph, 4, {3, 20});
  GaussSeidel smoother;
  smoother.analyze(*H.pattern, 1, groups.of_vertex, groups.color);
  std::vector<int> times(50, 0);
  for (const int v : smoother.order()) ++times[v];
  EXPECT_EQ(times, std::vector<int>(50, 1));
  for (size_t g = 0; g < groups.color.size(); ++g) {
    const auto [first, last] = smoother.vertices_of_group(static_cast<int>(g));
    for (int k = first; k < last; ++k) EXPECT_EQ(groups.of_vertex[smoother.order()[k]], static_cast<int>(g));
    EXPECT_EQ(last - first, std::count(groups.of_vertex.begin(), groups.of_vertex.end(), static_cast<int>(g)));
  }
}

TEST(GaussSeidel, IsBitReproducibleForAnyThreadCount) {
  for (const int rows_per_vertex : {1, 4}) {
    const Matrix H = rows_per_vertex == 1 ? spring_lattice({.nx = 40, .ny = 15, .nz = 15})  // thousands per color
                                          : vertex_matrix(3000, 4, 9);
    const Groups groups = make_groups(graph_of_vertices(*H.pattern, rows_per_vertex), 4);
    GaussSeidel smoother;
    smoother.analyze(*H.pattern, rows_per_vertex, groups.of_vertex, groups.color);
    const std::vector<double> random = random_vector(kFloatsPerRow * static_cast<size_t>(H.rows()), 10);
    const std::vector<float> b(random.begin(), random.end());
    const int threads = thread_count();
    std::vector<std::vector<float>> expected;
    for (const int count : {1, 2, 3, 8}) {
      set_thread_count(count);
      ASSERT_TRUE(smoother.load(H.values));
      std::vector<float> x(b.size(), 0.0F), r = x, y = x;
      smoother.sweep_forward(b.data(), x.data());
      smoother.residual_after_forward(x.data(), r.data());
      std::vector<float> before = x;
      smoother.sweep_backward(b.data(), x.data());
      smoother.multiply_after_backward(b.data(), before.data(), x.data(), y.data());
      if (expected.empty()) expected = {x, r, y};
      EXPECT_TRUE(expected[0] == x && expected[1] == r && expected[2] == y) << count << " threads";
    }
    set_thread_count(threads);
  }
}

TEST(GaussSeidel, ReportsIndefiniteDiagonalBlocks) {
  for (const int rows_per_vertex : {1, 4}) {
    Matrix H = vertex_matrix(30, rows_per_vertex, 11);
    const Groups groups = make_groups(graph_of_vertices(*H.pattern, rows_per_vertex), 3);
    GaussSeidel smoother;
    smoother.analyze(*H.pattern, rows_per_vertex, groups.of_vertex, groups.color);
    EXPECT_TRUE(smoother.load(H.values));
    Mat3d& block = H.values.block[H.pattern->diagonal(H.rows() / 2)];
    const Mat3d saved = block;
    block(1, 1) = -block(1, 1);
    EXPECT_FALSE(smoother.load(H.values));
    block = saved;
    if (rows_per_vertex == 4) {  // every 3x3 block is definite, but not the block of the vertex
      const Mat3d large = 100 * squared_norm(saved) * identity3<double>();
      add_block(H.values, 41, 40, large);
      EXPECT_FALSE(smoother.load(H.values));
      add_block(H.values, 41, 40, -1.0 * large);
    }
    EXPECT_TRUE(smoother.load(H.values));
  }
}

}  // namespace
}  // namespace aspic
