// Compact connected groups of vertices of about equal size: the aggregates of a multigrid method.
#pragma once
#include <span>
#include <vector>

#include "linalg/graph.h"
#include "math/small.h"

namespace aspic {

struct Aggregates {
  std::vector<int> of_vertex;  // -1: in none
  std::vector<int> start;      // count() + 1 entries
  std::vector<int> member;     // of aggregate a: member[start[a]] ... ascending
  int count() const { return static_cast<int>(start.size()) - 1; }
  std::span<const int> members(int a) const { return std::span(member).subspan(start[a], start[a + 1] - start[a]); }
};

// Whether neighbors of these stiffnesses hang together only weakly.
inline bool is_jump(double modulus, double other) { return modulus >= 10 * other || other >= 10 * modulus; }

struct AggregationInput {
  const Graph& graph;
  std::span<const Vec3d> position;
  std::span<const double> modulus = {};  // per vertex, any unit: aggregates do not cross large jumps of it
  std::span<const char> excluded = {};   // 1: the vertex is left out
  int size = 48;                         // wanted vertices per aggregate
};

// Halves the vertices along the longest side of their box until the parts are small and short enough, splits what does
// not hang together, and gives crumbs to the neighbor they touch most.
Aggregates make_aggregates(const AggregationInput& input);

}  // namespace aspic
