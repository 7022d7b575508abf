// An undirected graph on the rows of a matrix: who touches whom.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "linalg/block_sparse.h"

namespace aspic {

struct Graph {
  std::vector<int64_t> start;  // vertex_count() + 1
  std::vector<int> neighbor;   // of vertex v: neighbor[start[v]] ... ascending, without v
  int vertex_count() const { return static_cast<int>(start.size()) - 1; }
  std::span<const int> around(int v) const { return std::span(neighbor).subspan(start[v], start[v + 1] - start[v]); }
};

Graph graph_of(const BlockPattern& pattern);

// The graph of groups: those touch which have members that touch. group[v] < 0: v is in none.
Graph quotient(const Graph& graph, std::span<const int> group, int groups);

// Greedy: each vertex, in order, takes the first color that none of its neighbors has. One color per vertex.
std::vector<int> greedy_coloring(const Graph& graph);

}  // namespace aspic
