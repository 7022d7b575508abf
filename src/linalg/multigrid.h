// Multigrid cycle for elasticity, used as a preconditioner. The coarse spaces are affine displacements of aggregates of
// the rest shape, the smoother is Gauss-Seidel, and the coarsest level is factorized. Each coarse level is solved by
// two or three conjugate-gradient steps preconditioned by the cycle below (K-cycle, [Notay and Vassilevski 2008]),
// because functions that are discontinuous between aggregates are stiffer than the motions they approximate. The cycle
// runs in single precision; coarse matrices are computed in double precision.
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
  int aggregate_size = 48;        // rows per aggregate on the finest level
  int coarse_aggregate_size = 8;  // aggregates per aggregate on the coarser levels
  int coarsest_rows = 256;        // maximum rows of the factorized level; a larger disconnected level is smoothed only
};

// Converges faster if the rest positions of the pattern's rows are known. Rows without couplings (pinned vertices) are
// excluded.
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
    std::unique_ptr<BlockSparse> coarse;  // P' H P; null on a last level that is smoothed only
    std::vector<float> weight;            // weights of `coarsening`, 4 per row in the order of the smoother
    std::vector<int> coarse_place;        // place of each aggregate in the order of the next level
    std::vector<float> b, x;              // right-hand side and solution of H x = b
    std::vector<float> r;                 // b - H x
    std::vector<float> before;            // x before the last sweep
    std::vector<Direction> directions;    // search directions of the K-cycle
    std::vector<float> sum;               // partial solution of the K-cycle
  };
  bool ends_densely() const { return levels_.empty() || levels_.back().coarse; }
  void build(const BlockSparse& H);
  void reserve_vectors(Level& level, int rows, int first_steps);
  void connect_levels();
  void cycle(int l);  // one cycle for H x = b from x = 0
  void sweep_backward(int l);
  void solve(int l);
  void restrict_residual(const Level& level, std::span<float> coarse_b) const;
  void add_prolonged(std::span<const float> coarse_x, Level& level) const;
  bool factorize_coarsest(const BlockSparse& H);
  void solve_coarsest();

  MultigridOptions options_;
  const BlockPattern* pattern_ = nullptr;
  bool is_built_ = false;
  std::vector<char> isolated_, isolated_now_;  // rows without couplings (pinned)
  std::vector<Level> levels_;
  std::vector<float> coarsest_b_, coarsest_x_;
  std::vector<double> factor_, coarsest_;
  DenseCholesky dense_;
};

}  // namespace aspic
