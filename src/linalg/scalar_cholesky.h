// Sparse Cholesky factorization of symmetric matrices with scalar entries, such as those of a field with one value per
// element. Groups neighboring rows in threes for the 3x3 blocks of Cholesky.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "linalg/cholesky.h"

namespace aspic {

// Position of an entry in the lower triangle: column <= row.
struct MatrixPlace {
  int row = 0, column = 0;
};

class ScalarCholesky {
 public:
  // Sets the sparsity. Values of repeated places are added. Missing diagonal entries are 0.
  void analyze(int rows, std::span<const MatrixPlace> places);
  // Factorizes A with one value per place, in the order of analyze(). Returns false if A is not positive definite or
  // the factor does not fit into memory.
  bool factorize(std::span<const double> values);
  void solve(std::span<const double> b, std::span<double> x);  // A x = b; b and x may be the same

 private:
  void group_rows(std::span<const MatrixPlace> places);

  std::vector<int> slot_;                  // slot of each row: 3 block row + component
  std::unique_ptr<BlockPattern> pattern_;  // heap: its address must not change
  std::unique_ptr<BlockSparse> A_;
  std::vector<size_t> target_;  // index of each place in the values of A_
  std::unique_ptr<Cholesky> cholesky_;
  std::vector<double> b_, x_;
};

}  // namespace aspic
