// Symmetric Gauss-Seidel sweeps by 3x3 blocks in single precision, as the smoother of a multigrid cycle. Rows are
// visited group by group: groups of one colour do not touch and run in parallel, so the result does not depend on the
// threads.
#pragma once
#include <span>
#include <vector>

#include "linalg/block_sparse.h"
#include "math/quad.h"

namespace aspic {

using QuadF = Quad<float>;

// Vectors hold kFloatsPerRow floats for each row, in the order of the visit.
inline constexpr int kFloatsPerRow = 4;

class GaussSeidel {
 public:
  // Each `rows_per_vertex` (1 or 4) consecutive rows are solved for together. group[row] < 0: the row belongs to no
  // group and touches no row of one; it is visited last.
  void analyze(const BlockPattern& pattern, int rows_per_vertex, std::span<const int> group,
               std::span<const int> color_of_group);
  bool load(const BlockSparse& H);  // false: a diagonal block is not positive definite

  int rows() const { return static_cast<int>(order_.size()); }
  std::span<const int> order() const { return order_; }  // order()[k]: the row that is visited k-th
  struct Range {
    int first = 0, last = 0;
  };
  Range range_of_group(int group) const { return range_[group]; }

  // H = L + D + U in the order of the visit.
  void sweep_forward(const float* b, float* x) const;           // (L + D) x = b
  void sweep_backward(const float* b, float* x) const;          // (D + U) x = b - L x
  void multiply(const float* x, float* y) const;                // y = H x
  void residual_after_forward(const float* x, float* r) const;  // r = b - H x = -U x

 private:
  struct Triangle {
    std::vector<int64_t> start;
    std::vector<int> column;
    std::vector<int> source;   // slot of the block; its complement where the transpose is meant
    std::vector<float> value;  // 9 per block
  };
  static Quad<float> row_product(const Triangle& triangle, int row, const float* x);
  template <class Body>
  void for_each_task(bool ascending, const Body& body) const;

  std::vector<int> order_;
  std::vector<Range> range_;
  std::vector<std::vector<Range>> tasks_;  // per colour
  Triangle lower_, upper_;
  template <int B>
  void relax(int vertex, const float* b, float* x, bool upper_too) const;
  template <int B>
  bool load_diagonal(const BlockSparse& H, int vertex);

  int rows_per_vertex_ = 1;
  std::vector<float> own_, inverse_;  // diagonal blocks of the vertices, and their inverses: 3x3 blocks, row by row
};

}  // namespace aspic
