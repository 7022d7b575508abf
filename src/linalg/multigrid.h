// A multigrid cycle for elasticity as a preconditioner: coarse spaces of affine displacements of aggregates of the rest
// shape, Gauss-Seidel as the smoother, a dense factorization on the coarsest level. Coarse levels are solved by two
// or three steps of conjugate gradients preconditioned by the cycle below (K-cycle, [Notay and Vassilevski 2008]),
// because functions that jump between aggregates are stiffer than the motions they stand for. The cycle runs in single
// precision; coarse matrices are made in double.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "linalg/affine_coarsening.h"
#include "linalg/approximate_inverse.h"
#include "linalg/dense_cholesky.h"
#include "linalg/gauss_seidel.h"

namespace aspic {

struct MultigridOptions {
  int aggregate_size = 48;        // rows of the matrix
  int coarse_aggregate_size = 8;  // aggregates, from then on
  int coarsest_rows = 256;        // at most, on the level that is factorized; where rows that do not hang together are
                                  // more, they are smoothed only
};

// The better for knowing the rest positions of the pattern's rows. Rows without any coupling (pinned vertices) take no
// part.
class Multigrid : public ApproximateInverse {
 public:
  explicit Multigrid(const MultigridOptions& options = {}) : options_(options) {}

  std::string_view name() const override { return "multigrid"; }
  std::string description() const override;
  void analyze(const BlockPattern& pattern) override;
  bool factorize(const BlockSparse& H) override;
  void apply(std::span<const double> r, std::span<double> z) override;
  bool is_multigrid() const override { return true; }

  int level_count() const { return static_cast<int>(levels_.size()) + ends_densely(); }

 private:
  struct Direction {
    std::vector<float> p, q;  // q = H p
    double pq = 0;
  };
  struct Level {
    GaussSeidel smoother;
    AffineCoarsening coarsening;
    MatrixRestriction restriction;
    std::unique_ptr<BlockSparse> coarse;  // P' H P; none on a last level that is smoothed only
    std::vector<float> weight;            // coarsening, 4 per row in the order of the smoother
    std::vector<int> coarse_place;        // place of each aggregate in the order of the next level
    std::vector<float> b, x;              // H x = b
    std::vector<float> r;                 // b - H x
    std::vector<Direction> directions;    // search directions of the K-cycle
    std::vector<float> sum;               // solution of the K-cycle so far
  };
  bool ends_densely() const { return levels_.empty() || levels_.back().coarse; }
  void build(const BlockSparse& H);
  void reserve_vectors(Level& level, int rows, int first_steps);
  void connect_levels();
  void cycle(int l);  // one step for H x = b from x = 0
  void solve(int l);
  void restrict_residual(const Level& level, std::span<float> coarse_b) const;
  void add_prolonged(std::span<const float> coarse_x, Level& level) const;
  bool factorize_coarsest(const BlockSparse& H);
  void solve_coarsest();

  MultigridOptions options_;
  const BlockPattern* pattern_ = nullptr;
  bool is_built_ = false;
  std::vector<char> isolated_, isolated_now_;  // rows without couplings: pinned
  std::vector<Level> levels_;
  std::vector<float> coarsest_b_, coarsest_x_;
  std::vector<double> factor_, coarsest_;
  DenseCholesky dense_;
};

}  // namespace aspic
