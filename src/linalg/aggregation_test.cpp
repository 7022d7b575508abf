#include "linalg/aggregation.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "linalg/matrices_test.h"

namespace aspic {
namespace {

using namespace test;

constexpr size_t kMinSize = 5;  // smaller aggregates have less freedom than an affine displacement

bool is_strong(const AggregationInput& in, int v, int w) {
  if (in.modulus.empty()) return true;
  return std::max(in.modulus[v], in.modulus[w]) < 10 * std::min(in.modulus[v], in.modulus[w]);
}

// Returns the number of vertices that strong couplings connect with the first member within the aggregate.
size_t reachable(const AggregationInput& in, const Aggregates& aggregates, int a) {
  std::vector<int> queue = {aggregates.members(a)[0]};
  std::vector<char> seen(in.graph.vertex_count(), 0);
  seen[queue[0]] = 1;
  for (size_t head = 0; head < queue.size(); ++head)
    for (const int w : in.graph.around(queue[head]))
      if (!seen[w] && aggregates.of_vertex[w] == a && is_strong(in, queue[head], w)) seen[w] = 1, queue.push_back(w);
  return queue.size();
}

bool has_strong_neighbor(const AggregationInput& in, const Aggregates& aggregates, int a) {
  for (const int v : aggregates.members(a))
    for (const int w : in.graph.around(v))
      if (aggregates.of_vertex[w] >= 0 && aggregates.of_vertex[w] != a && is_strong(in, v, w)) return true;
  return false;
}

// Checks the properties that hold for every input.
void expect_valid(const AggregationInput& in, const Aggregates& aggregates) {
  const int n = in.graph.vertex_count();
  ASSERT_EQ(static_cast<int>(aggregates.of_vertex.size()), n);
  std::vector<int> times(n, 0);
  for (int a = 0; a < aggregates.count(); ++a) {
    const auto members = aggregates.members(a);
    ASSERT_FALSE(members.empty()) << a;
    EXPECT_TRUE(std::is_sorted(members.begin(), members.end())) << a;
    for (const int v : members) {
      ++times[v];
      EXPECT_EQ(aggregates.of_vertex[v], a);
    }
    EXPECT_EQ(reachable(in, aggregates, a), members.size()) << "aggregate " << a << " is disconnected";
    if (members.size() < kMinSize) {
      EXPECT_FALSE(has_strong_neighbor(in, aggregates, a)) << "aggregate " << a << " is too small";
    }
  }
  for (int v = 0; v < n; ++v) {
    const bool is_excluded = !in.excluded.empty() && in.excluded[v];
    EXPECT_EQ(times[v], is_excluded ? 0 : 1) << v;
    EXPECT_EQ(aggregates.of_vertex[v] < 0, is_excluded) << v;
  }
}

Aggregates valid_aggregates(const AggregationInput& in) {
  Aggregates aggregates = make_aggregates(in);
  expect_valid(in, aggregates);
  return aggregates;
}

TEST(Aggregation, HasCompactPartsOfRequestedSizeInBox) {
  const Matrix H = spring_lattice({.nx = 15, .ny = 11, .nz = 11});
  const Graph graph = graph_of(*H.pattern);
  for (const int size : {8, 48}) {
    const AggregationInput in = {.graph = graph, .position = H.pattern->rest_position, .size = size};
    const Aggregates aggregates = valid_aggregates(in);
    // A part of n vertices is bisected while n / size rounds to two or more, or while it is longer than 0.9 cbrt(size)
    // edges, which are up to sqrt(3) cells long.
    const double longest = std::sqrt(3.0) * 0.9 * std::cbrt(size);
    for (int a = 0; a < aggregates.count(); ++a) {
      const auto members = aggregates.members(a);
      EXPECT_LT(static_cast<double>(members.size()), 1.5 * size);
      EXPECT_GE(members.size(), kMinSize);
      for (int k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax_element(members.begin(), members.end(), [&](int v, int w) {
          return H.pattern->rest_position[v][k] < H.pattern->rest_position[w][k];
        });
        if (members.size() >= 2 * kMinSize) {
          EXPECT_LE(H.pattern->rest_position[*high][k] - H.pattern->rest_position[*low][k], longest);
        }
      }
    }
    EXPECT_LE(aggregates.count(), 3 * H.rows() / size);
  }
}

TEST(Aggregation, HasShortPartsInThinRod) {
  const Matrix H = spring_lattice({.nx = 200, .ny = 1, .nz = 1});
  const Graph graph = graph_of(*H.pattern);
  const Aggregates aggregates = valid_aggregates({.graph = graph, .position = H.pattern->rest_position});
  // 48 vertices would be 12 cells long; 0.9 cbrt(48) = 3.3 edges are at most 5.7 cells.
  for (int a = 0; a < aggregates.count(); ++a) {
    const auto members = aggregates.members(a);
    EXPECT_LE(H.pattern->rest_position[members.back()][0] - H.pattern->rest_position[members.front()][0], 5.7);
  }
}

TEST(Aggregation, DoesNotCrossModulusJump) {
  const Matrix H = spring_lattice({.nx = 9, .ny = 9, .nz = 9});
  const Graph graph = graph_of(*H.pattern);
  std::vector<double> modulus;
  for (const Vec3d& X : H.pattern->rest_position) modulus.push_back(X[0] + 0.3 * X[1] < 5.1 ? 1e4 : 1e6);
  const Aggregates aggregates =
      valid_aggregates({.graph = graph, .position = H.pattern->rest_position, .modulus = modulus});
  for (int a = 0; a < aggregates.count(); ++a)
    for (const int v : aggregates.members(a)) EXPECT_EQ(modulus[v], modulus[aggregates.members(a)[0]]);
}

TEST(Aggregation, OmitsExcludedVertices) {
  const Matrix H = spring_lattice({.nx = 12, .ny = 6, .nz = 6});
  const Graph graph = graph_of(*H.pattern);
  std::vector<char> excluded;
  for (const Vec3d& X : H.pattern->rest_position) excluded.push_back(X[0] < 2 || X[0] == 7);  // the rest has two parts
  const AggregationInput in = {.graph = graph, .position = H.pattern->rest_position, .excluded = excluded};
  valid_aggregates(in);
  std::fill(excluded.begin(), excluded.end(), 1);
  EXPECT_EQ(valid_aggregates(in).count(), 0);
}

TEST(Aggregation, KeepsBodiesApart) {
  Couplings couplings;
  std::vector<Vec3d> position;
  for (int body = 0; body < 10; ++body)  // rings of 4 and single vertices, all at one place
    for (int k = 0; k < 5; ++k) {
      position.push_back({{0.1 * k, 0.01 * body, 0}});
      if (k < 4) couplings.emplace_back(5 * body + k, 5 * body + (k + 1) % 4);
    }
  const Graph graph = graph_of(make_pattern(50, couplings));
  EXPECT_EQ(valid_aggregates({.graph = graph, .position = position}).count(), 20);
}

TEST(Aggregation, MergesTinyAggregatesIntoNeighbor) {
  const Graph path = graph_of(make_pattern(7, {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}, {5, 6}}));
  std::vector<Vec3d> position(7);
  for (int v = 0; v < 7; ++v) position[v][0] = v;
  EXPECT_EQ(valid_aggregates({.graph = path, .position = position, .size = 3}).count(), 1);
}

TEST(Aggregation, WorksWithoutPositions) {
  for (const int cells : {1, 5, 9}) {
    const Matrix H = spring_lattice({.nx = cells, .ny = cells, .nz = cells});
    const Graph graph = graph_of(*H.pattern);
    const std::vector<Vec3d> no_positions(H.rows());
    const Aggregates aggregates = valid_aggregates({.graph = graph, .position = no_positions});
    EXPECT_GE(aggregates.count(), H.rows() / 72);
  }
}

TEST(Aggregation, IsValidForRandomGraphs) {
  for (const int rows : {0, 1, 2, 30, 400})
    for (const unsigned seed : {1U, 2U, 3U}) {
      const Graph graph = graph_of(make_pattern(rows, random_couplings(rows, rows, seed)));
      const std::vector<double> random = random_vector(5 * rows, seed + 10);
      std::vector<Vec3d> position(rows);
      std::vector<double> modulus(rows);
      std::vector<char> excluded(rows);
      for (int v = 0; v < rows; ++v) {
        position[v] = {{random[5 * v], random[5 * v + 1], random[5 * v + 2]}};
        modulus[v] = std::exp(2 * random[5 * v + 3]);
        excluded[v] = random[5 * v + 4] < -0.8;
      }
      for (const int size : {1, 2, 8, 48}) valid_aggregates({graph, position, modulus, excluded, size});
    }
}

TEST(Aggregation, IsDeterministic) {
  const Matrix H = spring_lattice({.nx = 8, .ny = 8, .nz = 8});
  const Graph graph = graph_of(*H.pattern);
  const AggregationInput in = {.graph = graph, .position = H.pattern->rest_position, .size = 20};
  const Aggregates once = make_aggregates(in), again = make_aggregates(in);
  EXPECT_EQ(once.of_vertex, again.of_vertex);
  EXPECT_EQ(once.member, again.member);
}

}  // namespace
}  // namespace aspic
