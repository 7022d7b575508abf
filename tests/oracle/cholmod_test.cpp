// Compares the project's Cholesky factorization with CHOLMOD: equal solutions and definiteness, comparable fill.
#include <gtest/gtest.h>
#include <suitesparse/cholmod.h>

#include <cmath>

#include "linalg/cholesky.h"
#include "linalg/matrices_test.h"

namespace aspic {
namespace {

using namespace test;

class Oracle {
 public:
  explicit Oracle(const BlockSparse& H) {
    cholmod_start(&common_);
    common_.supernodal = CHOLMOD_SUPERNODAL;
    common_.final_ll = true;
    common_.print = 0;
    A_ = compressed(H);
    L_ = cholmod_analyze(A_, &common_);
    cholmod_factorize(A_, L_, &common_);
  }
  ~Oracle() {
    cholmod_free_factor(&L_, &common_);
    cholmod_free_sparse(&A_, &common_);
    cholmod_finish(&common_);
  }
  Oracle(const Oracle&) = delete;
  Oracle& operator=(const Oracle&) = delete;

  bool is_definite() const { return L_->minor == L_->n; }
  double nnz() const { return common_.lnz; }

  std::vector<double> solve(const std::vector<double>& b) {
    cholmod_dense* B = cholmod_allocate_dense(b.size(), 1, b.size(), CHOLMOD_REAL, &common_);
    std::copy(b.begin(), b.end(), static_cast<double*>(B->x));
    cholmod_dense* X = cholmod_solve(CHOLMOD_A, L_, B, &common_);
    const double* first = static_cast<const double*>(X->x);
    const std::vector<double> x(first, first + b.size());
    cholmod_free_dense(&B, &common_);
    cholmod_free_dense(&X, &common_);
    return x;
  }

 private:
  cholmod_sparse* compressed(const BlockSparse& H) {
    const BlockPattern& p = *H.pattern;
    const size_t n = 3 * p.rows();
    cholmod_triplet* T = cholmod_allocate_triplet(n, n, 9 * p.block_count(), -1, CHOLMOD_REAL, &common_);
    for (int r = 0; r < p.rows(); ++r)
      for (int64_t s = p.row_start[r]; s < p.row_start[r + 1]; ++s)
        for (int k = 0; k < 9; ++k) {
          const int row = 3 * r + k % 3, col = 3 * p.column[s] + k / 3;
          if (row < col) continue;
          static_cast<int*>(T->i)[T->nnz] = row;
          static_cast<int*>(T->j)[T->nnz] = col;
          static_cast<double*>(T->x)[T->nnz++] = H.block[s].a[k];
        }
    cholmod_sparse* A = cholmod_triplet_to_sparse(T, T->nnz, &common_);
    cholmod_free_triplet(&T, &common_);
    return A;
  }

  cholmod_common common_;
  cholmod_sparse* A_ = nullptr;
  cholmod_factor* L_ = nullptr;
};

void expect_same(const Matrix& H, double condition) {
  const std::vector<double> b = random_vector(3 * H.rows(), 1);
  std::vector<double> x(b.size());
  Oracle oracle(H.values);
  Cholesky own;
  own.analyze(*H.pattern);
  ASSERT_TRUE(own.factorize(H.values));
  ASSERT_TRUE(oracle.is_definite());
  ASSERT_TRUE(own.solve(b, x, 1e-12).ok);
  const std::vector<double> expected = oracle.solve(b);
  std::vector<double> difference(x.size());
  for (size_t i = 0; i < x.size(); ++i) difference[i] = x[i] - expected[i];
  // Both errors are small multiples of eps cond(H); the factor 100 covers the growth with these sizes.
  EXPECT_LE(std::sqrt(dot(difference, difference) / dot(expected, expected)), 100 * 2.2e-16 * condition);
  // Relaxed supernodes and full diagonal blocks store some zeros.
  EXPECT_LE(static_cast<double>(own.analysis().nnz), 2 * oracle.nnz() + 100.0 * H.rows());
}

TEST(CholmodOracle, AgreesOnRandomMatrices) {
  for (unsigned seed = 1; seed <= 5; ++seed)
    expect_same(random_dominant(300, random_couplings(300, 900, seed), seed),
                10);  // condition number by Gershgorin: below 10
}

TEST(CholmodOracle, AgreesOnLattices) {
  // Each of at most 14 springs at a vertex adds at most 2 k to the largest eigenvalue. The smallest eigenvalue is the
  // mass.
  for (const double stiffness : {1.0, 1e4})
    expect_same(spring_lattice({.nx = 20, .ny = 8, .nz = 8, .stiffness = stiffness}), 1 + 28 * stiffness);
}

TEST(CholmodOracle, AgreesOnDefiniteness) {
  for (const double mass : {1e-2, 1e-5, -1e-5, -1e-2}) {
    const Matrix H = spring_lattice({.nx = 8, .ny = 7, .nz = 6, .mass = mass});
    Cholesky own;
    own.analyze(*H.pattern);
    EXPECT_EQ(own.factorize(H.values), Oracle(H.values).is_definite()) << "mass " << mass;
  }
}

}  // namespace
}  // namespace aspic
