// Sparse Cholesky factorization H = P' L L' P: multifrontal and supernodal [Duff and Reid 1983; Liu 1992], on 3x3
// blocks.
#pragma once
#include <limits>
#include <memory>

#include "linalg/dense_cholesky.h"
#include "linalg/elimination.h"
#include "linalg/linear_solver.h"
#include "linalg/subtrees.h"

namespace aspic {

class Cholesky : public LinearSolver {
 public:
  // Rejects a factor that needs more than `memory_limit` bytes, or more than the free memory when it is first needed.
  explicit Cholesky(int64_t memory_limit = std::numeric_limits<int64_t>::max()) : memory_limit_(memory_limit) {}

  std::string_view name() const override { return "cholesky"; }
  std::string description() const override;
  void analyze(const BlockPattern& pattern) override;
  // Factorizes H without its stencils. Returns false if H is not positive definite, or if the factor does not fit into
  // memory (see refused()).
  bool factorize(const BlockSparse& H) override;
  SolveReport solve(std::span<const double> b, std::span<double> x, double tolerance) override;

  // Computes x = (L L')^-1 b with the last factor, which may belong to another matrix: a preconditioner for similar
  // matrices. Returns false if there is no factor.
  bool substitute(std::span<const double> b, std::span<double> x);
  double substitutions_per_factorization()
      const;  // cost of a factorization divided by that of a substitution; 0: no factor

  const CholeskyAnalysis& analysis() const { return supernodes_.cost; }  // valid after analyze()
  bool refused() const { return refused_; }                              // the last factor did not fit into memory

 private:
  struct Front;  // the panel and the update matrix of a supernode
  bool allocate();
  void find_targets();
  Front front(int s);
  bool factorize_supernode(const BlockSparse& H, int s, DenseCholesky& kernels);
  static void clear_panel(const Front& front, int first, int last);  // columns of blocks
  void assemble(const BlockSparse& H, int s, int first, int last);
  void add_children(int s, const Front& front, int first, int last);
  bool pivots_are_sound(const BlockSparse& H, int s, const double* panel) const;
  double residual(std::span<const double> b, std::span<const double> x);  // returns the norm of b - A x
  void add_substituted(std::span<const double> b, std::span<double> x);   // x += (L L')^-1 b
  void substitute_forward(int s);
  void substitute_backward(int s);

  int64_t memory_limit_;
  const BlockPattern* pattern_ = nullptr;
  const BlockSparse* H_ = nullptr;
  bool allocated_ = false, refused_ = false;
  int64_t free_bytes_ = 0;  // free memory when the factor was refused
  Supernodes supernodes_;
  Subtrees subtrees_;
  std::vector<int> last_child_, sibling_;  // supernodal tree; children in reverse order
  std::vector<DenseCholesky> kernels_;     // one per task, then one for the top
  LargeVector<double> L_;                  // the panels, column-major
  LargeVector<double> workspace_;  // update matrices; during a solve, right-hand sides of the rows below each panel
  std::vector<int64_t> target_;    // index in L_ of each block of H
  std::vector<double> permuted_, residual_;
  // Conjugate gradients for matrices with stencils, preconditioned by the factorization of the matrix without them.
  std::unique_ptr<LinearSolver> with_stencils_;
};

}  // namespace aspic
