// Dense kernels of the sparse factorisation, on column-major lower trapezoids whose sizes are multiples of 3.
// Arrays must be readable for kReadAhead doubles past their last entry: edge tiles load whole SIMD lanes and drop them.
#pragma once
#include <cstddef>
#include <vector>

namespace aspic {

inline constexpr int kReadAhead = 32;

class DenseCholesky {
 public:
  DenseCholesky();

  // In place: the first `columns` rows become L11 with L11 L11' = A11, the rows below become L21 = A21 L11^-T.
  // Entries above the diagonal are neither read for the result nor written. False: a pivot is not positive.
  bool factorize(double* A, int rows, int columns, std::ptrdiff_t stride);

  // C(i, j) -= sum_p A(i, p) A(j, p) for i in [j, rows), j in [0, columns), p in [0, depth).
  void subtract_outer_product(const double* A, std::ptrdiff_t A_stride, int depth, double* C, std::ptrdiff_t C_stride,
                              int rows, int columns);

 private:
  std::vector<double> packed_left_, packed_right_;
};

// y -= L21 x and y = L11^-1 y, fused: v = [x; y] holds the right-hand side of the panel's rows.
void solve_forward(const double* L, int rows, int columns, double* v);
// The transposed solve: v = [x; y] with y known; x = L11^-T (x - L21' y).
void solve_backward(const double* L, int rows, int columns, double* v);

}  // namespace aspic
