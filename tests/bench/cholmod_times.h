// Times of CHOLMOD's factorization; zero without the library.
#pragma once
#include <algorithm>
#include <limits>
#include <memory>
#include <span>

#include "linalg/block_sparse.h"

namespace aspic::bench {

struct CholeskyTimes {  // times [s]
  double analysis = std::numeric_limits<double>::max();
  double factorization = analysis, solve = analysis;

  void lower_to(const CholeskyTimes& other) {
    analysis = std::min(analysis, other.analysis);
    factorization = std::min(factorization, other.factorization);
    solve = std::min(solve, other.solve);
  }
};

class Cholmod {
 public:
  explicit Cholmod(const BlockSparse& H);
  ~Cholmod();
  CholeskyTimes run_once(std::span<const double> b);  // CPU times with its default ordering and supernodal method

 private:
  struct Matrix;
  std::unique_ptr<Matrix> matrix_;
};

}  // namespace aspic::bench
