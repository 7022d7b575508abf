#include "bench/cholmod_times.h"

#if defined(ASPIC_CHOLMOD)

#include <suitesparse/cholmod.h>

#include "bench/stopwatch.h"

namespace aspic::bench {

struct Cholmod::Matrix {
  cholmod_common common;
  cholmod_sparse* A = nullptr;
};

Cholmod::Cholmod(const BlockSparse& H) : matrix_(std::make_unique<Matrix>()) {
  cholmod_common& common = matrix_->common;
  cholmod_start(&common);
  common.supernodal = CHOLMOD_SUPERNODAL;
  common.final_ll = true;
  const BlockPattern& p = *H.pattern;
  const size_t n = 3 * static_cast<size_t>(p.rows());
  cholmod_triplet* T = cholmod_allocate_triplet(n, n, 9 * p.block_count(), -1, CHOLMOD_REAL, &common);
  for (int r = 0; r < p.rows(); ++r)
    for (int64_t s = p.row_start[r]; s < p.row_start[r + 1]; ++s)
      for (int k = 0; k < 9; ++k) {
        const int row = 3 * r + k % 3, column = 3 * p.column[s] + k / 3;
        if (row < column) continue;
        static_cast<int*>(T->i)[T->nnz] = row;
        static_cast<int*>(T->j)[T->nnz] = column;
        static_cast<double*>(T->x)[T->nnz++] = H.block[s].a[k];
      }
  matrix_->A = cholmod_triplet_to_sparse(T, T->nnz, &common);
  cholmod_free_triplet(&T, &common);
}

Cholmod::~Cholmod() {
  cholmod_free_sparse(&matrix_->A, &matrix_->common);
  cholmod_finish(&matrix_->common);
}

CholeskyTimes Cholmod::run_once(std::span<const double> b) {
  cholmod_common* common = &matrix_->common;
  CholeskyTimes times;
  const Stopwatch analysis;
  cholmod_factor* L = cholmod_analyze(matrix_->A, common);
  times.analysis = analysis.cpu_seconds();
  cholmod_factorize(matrix_->A, L, common);  // touches the memory
  const Stopwatch factorization;
  cholmod_factorize(matrix_->A, L, common);
  times.factorization = factorization.cpu_seconds();
  cholmod_dense* B = cholmod_allocate_dense(b.size(), 1, b.size(), CHOLMOD_REAL, common);
  std::copy(b.begin(), b.end(), static_cast<double*>(B->x));
  cholmod_dense *X = nullptr, *Y = nullptr, *E = nullptr;
  for (int warm = 0; warm < 2; ++warm) {  // the second run reuses the memory of the first
    const Stopwatch solve;
    cholmod_solve2(CHOLMOD_A, L, B, nullptr, &X, nullptr, &Y, &E, common);
    times.solve = solve.cpu_seconds();
  }
  for (cholmod_dense** dense : {&B, &X, &Y, &E}) cholmod_free_dense(dense, common);
  cholmod_free_factor(&L, common);
  return times;
}

}  // namespace aspic::bench

#else

namespace aspic::bench {

struct Cholmod::Matrix {};
Cholmod::Cholmod(const BlockSparse&) {}
Cholmod::~Cholmod() = default;
CholeskyTimes Cholmod::run_once(std::span<const double>) { return {}; }

}  // namespace aspic::bench

#endif
