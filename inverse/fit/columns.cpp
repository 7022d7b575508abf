#include "fit/columns.h"

#include "base/check.h"
#include "base/parallel.h"

namespace aspic {

std::vector<double> product_transposed(const Columns& A, std::span<const double> v) {
  std::vector<double> c(A.count());
  parallel_for(A.count(), [&](int j) { c[j] = dot(A[j], v); });
  return c;
}

std::vector<double> product_transposed(const Columns& A, const Columns& B) {
  const int rows = A.count();
  std::vector<double> C(static_cast<size_t>(rows) * B.count());
  parallel_for(B.count(), [&](int j) {
    for (int i = 0; i < rows; ++i) C[i + static_cast<size_t>(rows) * j] = dot(A[i], B[j]);
  });
  return C;
}

void add_product(const Columns& A, std::span<const double> c, double scale, std::span<double> y) {
  ASPIC_CHECK(static_cast<int>(c.size()) == A.count());
  parallel_chunks(A.rows(), [&](int first, int last) {
    for (int j = 0; j < A.count(); ++j) {
      const double s = scale * c[j];
      const std::span<const double> column = A[j];
      for (int i = first; i < last; ++i) y[i] += s * column[i];
    }
  });
}

Columns product(const Columns& A, std::span<const double> C, int count) {
  ASPIC_CHECK(C.size() == static_cast<size_t>(A.count()) * count);
  Columns B(A.rows(), count);
  for (int j = 0; j < count; ++j) add_product(A, C.subspan(static_cast<size_t>(A.count()) * j, A.count()), 1, B[j]);
  return B;
}

}  // namespace aspic
