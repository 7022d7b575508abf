// Undirected graphs on the rows of a matrix.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "linalg/block_sparse.h"

namespace aspic {

struct Graph {
  std::vector<int64_t> start;  // vertex_count() + 1
  std::vector<int>
      neighbor;  // neighbors of vertex v without v: neighbor[start[v]], ..., neighbor[start[v + 1] - 1], ascending
  int vertex_count() const { return static_cast<int>(start.size()) - 1; }
  std::span<const int> around(int v) const { return std::span(neighbor).subspan(start[v], start[v + 1] - start[v]); }
};

Graph graph_of(const BlockPattern& pattern);

// Returns the graph of groups. Two groups are neighbors if they have neighboring members. group[v] < 0: v is in none.
Graph quotient(const Graph& graph, std::span<const int> group, int groups);

// Greedy coloring: each vertex, in order, gets the lowest color that none of its neighbors has. Returns the colors.
std::vector<int> greedy_coloring(const Graph& graph);

}  // namespace aspic
