// Symmetric Gauss-Seidel sweeps in single precision: the smoother of a multigrid cycle. Vertices are visited group by
// group. Groups of one color are not coupled and run in parallel, so the result is independent of the number of
// threads.
#pragma once
#include <span>
#include <vector>

#include "linalg/block_sparse.h"

namespace aspic {

// Vectors hold kFloatsPerRow floats per row, in the order of the visit: those of a vertex are the entries of its rows,
// then unused ones.
inline constexpr int kFloatsPerRow = 4;

class GaussSeidel {
 public:
  // A vertex has `rows_per_vertex` (1 or 4) consecutive rows, which are solved together. With 4 rows, two vertices are
  // coupled by all 16 blocks or none. group[v] < 0: vertex v belongs to no group, is coupled with no vertex of a group,
  // and is visited last.
  void analyze(const BlockPattern& pattern, int rows_per_vertex, std::span<const int> group,
               std::span<const int> color_of_group);
  bool load(const BlockSparse& H);  // false: the diagonal block of a vertex is not positive definite

  int rows() const { return static_cast<int>(order_.size()) * rows_per_vertex_; }
  std::span<const int> order() const { return order_; }  // order()[k]: the vertex that is visited k-th
  int rows_per_vertex() const { return rows_per_vertex_; }
  struct Range {
    int first = 0, last = 0;
  };
  Range vertices_of_group(int group) const { return range_[group]; }  // range of the group in the order

  // H = L + D + U in the order of the visit.
  void sweep_forward(const float* b, float* x) const;           // (L + D) x = b
  void sweep_backward(const float* b, float* x) const;          // (D + U) x = b - L x
  void residual_after_forward(const float* x, float* r) const;  // r = b - H x = -U x
  // y = H x = b - L (before - x), for the x of a backward sweep from `before`, which this overwrites with before - x.
  void multiply_after_backward(const float* b, float* before, const float* x, float* y) const;

 private:
  struct Triangle {
    std::vector<int64_t> start;  // per vertex
    LargeVector<int> column;
    std::vector<int> source;   // slot of the first block of the two vertices; bitwise complement: transposed
    LargeVector<float> value;  // blocks, see Kernel
  };
  template <int B>
  struct Kernel;
  template <class Body>
  void with_kernel(const Body& body) const;
  template <class Body>
  void for_each_task(bool ascending, const Body& body) const;

  int rows_per_vertex_ = 1;
  double work_per_vertex_ = 0;  // average multiplications per visit
  std::vector<int> order_;
  std::vector<Range> range_;
  std::vector<std::vector<Range>> tasks_;  // per color
  Triangle lower_, upper_;
  LargeVector<float> own_, inverse_;  // diagonal blocks of the vertices and their inverses
};

}  // namespace aspic
