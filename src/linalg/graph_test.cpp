#include "linalg/graph.h"

#include <gtest/gtest.h>

#include <set>

#include "linalg/matrices_test.h"

namespace aspic {
namespace {

using namespace test;

std::vector<std::set<int>> neighbors(int rows, const Couplings& couplings) {
  std::vector<std::set<int>> around(rows);
  for (const auto& [i, j] : couplings)
    if (i != j) around[i].insert(j), around[j].insert(i);
  return around;
}

void expect_graph(const Graph& graph, const std::vector<std::set<int>>& expected) {
  ASSERT_EQ(graph.vertex_count(), static_cast<int>(expected.size()));
  for (int v = 0; v < graph.vertex_count(); ++v) {
    const auto around = graph.around(v);
    EXPECT_EQ(std::vector(around.begin(), around.end()), std::vector(expected[v].begin(), expected[v].end())) << v;
  }
}

TEST(Graph, HasSortedCouplingsInBothDirections) {
  for (const int rows : {0, 1, 2, 40}) {
    const Couplings couplings = random_couplings(rows, 2 * rows, 1);
    expect_graph(graph_of(make_pattern(rows, couplings)), neighbors(rows, couplings));
  }
}

TEST(Graph, VerticesWithoutCouplingsHaveNoNeighbors) {
  const Graph graph = graph_of(make_pattern(4, {{3, 1}}));
  expect_graph(graph, {{}, {3}, {}, {1}});
  EXPECT_EQ(greedy_coloring(graph), (std::vector<int>{0, 0, 0, 1}));
}

TEST(Quotient, CouplesGroupsWithNeighboringMembers) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const int rows = 60, groups = 12;
    const Couplings couplings = random_couplings(rows, 80, seed);
    std::vector<int> group(rows);
    const std::vector<double> random = random_vector(rows, seed + 10);
    for (int v = 0; v < rows; ++v) group[v] = static_cast<int>((random[v] + 1) / 2 * (groups + 1)) - 1;  // some in none
    std::vector<std::set<int>> expected(groups);
    for (const auto& [i, j] : couplings) {
      const int a = group[i], b = group[j];
      if (a >= 0 && b >= 0 && a != b) expected[a].insert(b), expected[b].insert(a);
    }
    expect_graph(quotient(graph_of(make_pattern(rows, couplings)), group, groups), expected);
  }
}

TEST(Quotient, AcceptsEmptyGroups) {
  const Graph graph = graph_of(make_pattern(3, {{0, 1}, {1, 2}}));
  expect_graph(quotient(graph, std::vector{0, 2, 2}, 4), {{2}, {}, {0}, {}});
  expect_graph(quotient(graph, std::vector{-1, -1, -1}, 0), {});
  expect_graph(quotient(graph, std::vector{0, -1, 1}, 2),
               {{}, {}});  // a path through an ungrouped vertex does not count
}

TEST(GreedyColoring, UsesLowestPossibleColors) {
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    const int rows = 100;
    const Graph graph = graph_of(make_pattern(rows, random_couplings(rows, 120 * static_cast<int>(seed), seed)));
    const std::vector<int> color = greedy_coloring(graph);
    ASSERT_EQ(static_cast<int>(color.size()), rows);
    for (int v = 0; v < rows; ++v) {
      std::set<int> before;  // colors of the neighbors before v
      for (const int w : graph.around(v)) {
        EXPECT_NE(color[v], color[w]);
        if (w < v) before.insert(color[w]);
      }
      for (int c = 0; c < color[v]; ++c) EXPECT_TRUE(before.count(c)) << "vertex " << v << " could have color " << c;
    }
  }
}

}  // namespace
}  // namespace aspic
