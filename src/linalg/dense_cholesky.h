// Dense kernels of the sparse factorization, for column-major lower trapezoids whose sizes are multiples of 3. Arrays
// must be readable for kReadAhead doubles past their last entry, because edge tiles load whole SIMD packs.
#pragma once
#include <cstddef>
#include <vector>

#include "linalg/lower_matrix.h"

namespace aspic {

inline constexpr int kReadAhead = 32;

// Factorizes and multiplies dense panels. Large products run on all threads; the summation order is independent of
// their number. An object processes one panel at a time.
class DenseCholesky {
 public:
  // Allocates scratch for panels of up to the given size. Must be called first.
  void reserve(int rows, int columns);
  static std::size_t scratch(int rows, int columns);  // size of the scratch [doubles]

  // Factorizes in place: the first `columns` rows become L11 with L11 L11' = A11, the rows below become L21 = A21
  // L11^-T. Entries above the diagonal do not affect the result and are not written. Returns false if a pivot is not
  // positive.
  bool factorize(double* A, int rows, int columns, std::ptrdiff_t stride);

  enum class Product { set, subtract };
  // Computes C(i, j) = -S or C(i, j) -= S, where S = sum_p A(i, p) A(j, p), for i in [j, A.rows) and j in [0, columns).
  void put_outer_product(Product kind, ConstMatrix A, LowerMatrix C, int columns);

 private:
  std::vector<double> packed_left_, packed_right_;
};

}  // namespace aspic
