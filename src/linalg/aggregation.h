// Partitions a graph into compact connected groups of vertices of about equal size: the aggregates of multigrid.
#pragma once
#include <span>
#include <vector>

#include "linalg/graph.h"
#include "math/small.h"

namespace aspic {

struct Aggregates {
  std::vector<int> of_vertex;  // aggregate of each vertex; -1: none
  std::vector<int> start;      // count() + 1 entries
  std::vector<int> member;     // vertices of aggregate a: member[start[a]], ..., member[start[a + 1] - 1], ascending
  int count() const { return static_cast<int>(start.size()) - 1; }
  std::span<const int> members(int a) const { return std::span(member).subspan(start[a], start[a + 1] - start[a]); }
};

// Returns whether the ratio of two elastic moduli makes the coupling between them weak.
inline bool is_modulus_jump(double modulus, double other) { return modulus >= 10 * other || other >= 10 * modulus; }

struct AggregationInput {
  const Graph& graph;
  std::span<const Vec3d> position;
  std::span<const double> modulus = {};  // modulus of each vertex, any unit: aggregates do not cross large jumps
  std::span<const char> excluded = {};   // 1: the vertex is in no aggregate
  int size = 48;                         // target number of vertices per aggregate
};

// Bisects the vertices along the longest side of their bounding box until the parts are small and short enough, splits
// disconnected parts, and merges tiny aggregates into the neighbor with the most connections.
Aggregates make_aggregates(const AggregationInput& input);

}  // namespace aspic
