// CHOLMOD beside the project's own factorization; without the library its times are zero.
#pragma once
#include <algorithm>
#include <limits>
#include <memory>
#include <span>

#include "linalg/block_sparse.h"

namespace aspic::bench {

struct CholeskyTimes {  // [s]
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
  CholeskyTimes run_once(std::span<const double> b);  // processor times, its default order and supernodal method

 private:
  struct Matrix;
  std::unique_ptr<Matrix> matrix_;
};

}  // namespace aspic::bench
