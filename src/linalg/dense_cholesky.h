// Dense kernels of the sparse factorization, on column-major lower trapezoids whose sizes are multiples of 3.
// Arrays must be readable for kReadAhead doubles past their last entry: edge tiles load whole SIMD lanes and drop them.
#pragma once
#include <cstddef>
#include <vector>

#include "linalg/lower_matrix.h"

namespace aspic {

inline constexpr int kReadAhead = 32;

// Large products run on all threads; every entry is summed in the same order on any number of them. An object serves
// one panel at a time.
class DenseCholesky {
 public:
  // Scratch for panels of up to this many rows and columns; called before the others.
  void reserve(int rows, int columns);
  static std::size_t scratch(int rows, int columns);  // [doubles] that reserve() allocates

  // In place: the first `columns` rows become L11 with L11 L11' = A11, the rows below become L21 = A21 L11^-T.
  // Entries above the diagonal are neither read for the result nor written. False: a pivot is not positive.
  bool factorize(double* A, int rows, int columns, std::ptrdiff_t stride);

  enum class Product { set, subtract };
  // C(i, j) = -S or C(i, j) -= S, S = sum_p A(i, p) A(j, p), for i in [j, A.rows) and j in [0, columns).
  void put_outer_product(Product kind, ConstMatrix A, LowerMatrix C, int columns);

 private:
  std::vector<double> packed_left_, packed_right_;
};

}  // namespace aspic
