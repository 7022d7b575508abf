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

// Sorted pairs of places in the lists of a SurfacePrimitives, or of two.
struct ClosePairs {
  std::vector<std::array<int, 2>> vertex_triangle;  // (vertex, triangle)
  std::vector<std::array<int, 2>> edge_edge;        // (a, b); a < b in one list
  bool is_complete = true;                          // false: more pairs than the limit; both lists are empty
};

// Selects pairs. Threads call it at the same time.
class PairFilter {
 public:
  virtual ~PairFilter() = default;
  virtual bool accepts_vertex_triangle(int vertex, int triangle) const = 0;  // places in the lists
  virtual bool accepts_edge_edge(int a, int b) const = 0;                    // a < b in one list
};

struct PairQuery {
  std::span<const Box> path;  // of each position, a box around its path; see swept_boxes
  // Radius of each primitive, by which its box is inflated [m]; empty: 0.
  std::span<const double> vertex_radius, edge_radius, triangle_radius;
  const PairFilter* filter = nullptr;  // null: accepts all
  size_t limit = size_t{1} << 25;      // of the number of pairs of each kind
};

// Returns the boxes around the lines from x to x + dx, as rounded; [m]. An empty dx is zero.
std::vector<Box> swept_boxes(std::span<const Vec3d> x, std::span<const Vec3d> dx);

class PairFinder {
 public:
  explicit PairFinder(SurfacePrimitives primitives) : primitives_(std::move(primitives)) {}

  const SurfacePrimitives& primitives() const { return primitives_; }

  // Finds the accepted pairs without a common vertex whose inflated boxes overlap. The result is a function of the
  // query alone; trees of earlier queries only save time. O(n log n + pairs) while the surfaces are locally apart, with
  // memory for the pairs. Positions that are not finite are in no pair.
  ClosePairs find(const PairQuery& query);

  // Replaces the boxes by those of the query, for find_between().
  void place(const PairQuery& query);
  Box bounds() const;  // of all primitives, as placed
  // Finds the pairs of a vertex of this and a triangle of `other`, and if `has_edges` of an edge of each, whose boxes
  // overlap. Both are placed. `filter` and `limit` are as in PairQuery; the vertices of both count as different.
  ClosePairs find_between(const PairFinder& other, bool has_edges, const PairFilter* filter, size_t limit) const;

 private:
  // Rebuilt when motion has made it loose.
  struct Tree {
    std::vector<Box> boxes;
    std::vector<BoxTree> tree;  // one; none before the first query
    double looseness = 0;       // when it was built

    void fit();
    const BoxTree& operator*() const { return tree.front(); }
  };

  SurfacePrimitives primitives_;
  Tree vertices_, edges_, triangles_;
};

}  // namespace aspic
