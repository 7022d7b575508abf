// Sparse Cholesky H = P' L L' P: multifrontal and supernodal [Duff and Reid 1983; Liu 1992], on blocks of 3.
#pragma once
#include <limits>

#include "linalg/dense_cholesky.h"
#include "linalg/elimination.h"
#include "linalg/linear_solver.h"

namespace aspic {

class Cholesky : public LinearSolver {
 public:
  // A factor that needs more than `memory_limit` bytes, or more than is free when it is first wanted, is refused.
  explicit Cholesky(int64_t memory_limit = std::numeric_limits<int64_t>::max()) : memory_limit_(memory_limit) {}

  std::string_view name() const override { return "cholesky"; }
  std::string description() const override;
  void analyze(const BlockPattern& pattern) override;
  // False: H is not positive definite, or the factor does not fit into memory (refused()).
  bool factorize(const BlockSparse& H) override;
  SolveReport solve(std::span<const double> b, std::span<double> x, double tolerance) override;

  const CholeskyAnalysis& analysis() const { return supernodes_.cost; }  // valid after analyze()
  bool refused() const { return refused_; }                              // the last factorize() for want of memory

 private:
  bool allocate();
  bool factorize_supernode(const BlockSparse& H, int s);
  void assemble(const BlockSparse& H, int s, double* panel);
  void add_update(int child, int s, double* panel, double* update);
  bool pivots_are_sound(const BlockSparse& H, int s, const double* panel) const;
  void substitute(std::span<const double> b, std::span<double> x);  // x += (L L')^-1 b

  int64_t memory_limit_;
  const BlockPattern* pattern_ = nullptr;
  const BlockSparse* H_ = nullptr;
  bool allocated_ = false, refused_ = false;
  int64_t free_bytes_ = 0;  // what was free when the factor was refused
  Supernodes supernodes_;
  std::vector<int> last_child_, sibling_;  // of the supernodal tree; children in reverse
  DenseCholesky kernels_;
  std::vector<double> L_;      // the panels, column-major
  std::vector<double> stack_;  // update matrices that wait for their parents
  int64_t stack_top_ = 0;
  std::vector<int> local_;  // row of the current front for each block row
  std::vector<double> permuted_, front_, residual_;
  double H_norm_ = 0;  // the largest absolute row sum of blocks' norms bounds |H|
};

}  // namespace aspic
