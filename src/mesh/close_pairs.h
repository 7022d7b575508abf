// Pairs of surface primitives that can come close to each other while their points move: the broad phase of contact.
#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "mesh/box_tree.h"

namespace aspic {

// Primitives of one or several surfaces, as indices of positions.
struct SurfacePrimitives {
  std::vector<int> vertices;
  std::vector<std::array<int, 2>> edges;
  std::vector<Triangle> triangles;
};

// Sorted pairs of indices into the lists of one or two SurfacePrimitives.
struct ClosePairs {
  std::vector<std::array<int, 2>> vertex_triangle;  // (vertex, triangle)
  std::vector<std::array<int, 2>> edge_edge;        // (a, b); a < b in one list
  bool is_complete = true;                          // false: more pairs than the limit; both lists are empty
};

// Selects pairs. Called concurrently by threads.
class PairFilter {
 public:
  virtual ~PairFilter() = default;
  virtual bool accepts_vertex_triangle(int vertex, int triangle) const = 0;  // indices into the lists
  virtual bool accepts_edge_edge(int a, int b) const = 0;                    // a < b in one list
};

struct PairQuery {
  std::span<const Vec3d> x;         // positions [m]
  std::span<const Vec3d> dx = {};   // their displacements [m]; empty: 0
  std::span<const double> by = {};  // radius of the ball around each moving position [m]; empty: 0
  // Radius of each primitive, by which its box is inflated in addition [m]; empty: 0.
  std::span<const double> vertex_radius, edge_radius, triangle_radius;
  std::span<const char> is_new = {};   // of each position; pairs without a new one are not found; empty: all are new
  const PairFilter* filter = nullptr;  // null: accepts all
  size_t limit = size_t{1} << 25;      // maximum number of pairs of each kind
};

class PairFinder {
 public:
  explicit PairFinder(SurfacePrimitives primitives) : primitives_(std::move(primitives)) {}

  const SurfacePrimitives& primitives() const { return primitives_; }

  // Finds the accepted pairs without a common vertex whose inflated boxes overlap while they move. The result depends
  // on the query alone; trees of earlier queries only save time. Costs O(n log n + pairs) while the surfaces are
  // locally separated, with memory proportional to the pairs. Positions that are not finite are in no pair.
  ClosePairs find(const PairQuery& query);

  // Sets the boxes of the query, for find_between().
  void place(const PairQuery& query);
  // Finds pairs with overlapping boxes: a vertex of this and a triangle of `other`, and with `has_edges` an edge of
  // each. Requires that both are placed. `filter` and `limit` are as in PairQuery; vertices of this and `other` count
  // as different.
  ClosePairs find_between(const PairFinder& other, bool has_edges, const PairFilter* filter, size_t limit) const;

 private:
  // Rebuilt when motion has degraded it.
  struct Tree {
    std::vector<SweptBox> boxes;
    std::vector<SweptBoxTree> tree;  // one tree; empty before the first query
    double looseness = 0;            // looseness when it was built

    void fit();
    const SweptBoxTree& operator*() const { return tree.front(); }
  };

  SurfacePrimitives primitives_;
  Tree vertices_, edges_, triangles_;
};

}  // namespace aspic
