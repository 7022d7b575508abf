// Sparse Cholesky for symmetric matrices of plain numbers, such as those of a field with one value per element: rows
// that touch are put together in threes, for the factorization of blocks.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "linalg/cholesky.h"

namespace aspic {

// A place in the lower triangle: column <= row.
struct MatrixPlace {
  int row = 0, column = 0;
};

class ScalarCholesky {
 public:
  // Places may be named repeatedly: their values are added. Diagonal entries that are not named are 0.
  void analyze(int rows, std::span<const MatrixPlace> places);
  // One value per place, in the same order. False: A is not positive definite, or the factor does not fit into memory.
  bool factorize(std::span<const double> values);
  void solve(std::span<const double> b, std::span<double> x);  // A x = b; they may be the same

 private:
  void put_together(std::span<const MatrixPlace> places);

  std::vector<int> slot_;                  // slot of each row: 3 block row + component
  std::unique_ptr<BlockPattern> pattern_;  // at a fixed address
  std::unique_ptr<BlockSparse> A_;
  std::vector<size_t> target_;  // index of each place in the values of A_
  std::unique_ptr<Cholesky> cholesky_;
  std::vector<double> b_, x_;
};

}  // namespace aspic
