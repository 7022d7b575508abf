// Chooses by predicted cost between a factorization and conjugate gradients with one of two preconditioners.
#pragma once
#include <array>

#include "linalg/cholesky.h"
#include "linalg/cholesky_cost.h"
#include "linalg/conjugate_gradient.h"

namespace aspic {

// Predicts the number of iterations in which conjugate gradients with block-Jacobi reduce the residual by two digits,
// from the ratio of the stiffness of a uniform displacement to the diagonal. Time steps of soft bodies are easy,
// because the mass dominates; stiff bodies and statics are hard.
double predict_iterations(const BlockSparse& H);
double predict_iterations(const BlockSparse& H, std::vector<char>& scratch);
// The sums behind the prediction, over the first `rows` rows, for matrices of which processes have a part each.
struct UniformStiffness {
  double uniform = 0, diagonal = 0;  // 1' H 1 and 1' D 1 over the rows away from pinned vertices
};
UniformStiffness uniform_stiffness(const BlockSparse& H, int rows, std::vector<char>& scratch);
double predict_iterations(const UniformStiffness& stiffness);

// Predicts the cheapest solver for each sequence of matrices from its first one: a factorization, or conjugate
// gradients with multigrid or block-Jacobi. If the chosen solver does not converge, the next one in the order
// block_jacobi, multigrid, cholesky replaces it; cholesky only if its factor fits into memory, and once the cycles of a
// solve have cost a factorization. Multigrid returns for the next matrix if it has cost less than that on average. The
// choice depends neither on clocks nor on earlier sequences, so a resumed run makes the same choices. Only if the
// factor nearly fills the free memory may two runs differ.
class AutoSolver : public LinearSolver {
 public:
  // `solves`: approximate number of right-hand sides per factorization.
  explicit AutoSolver(int64_t memory_limit = std::numeric_limits<int64_t>::max(), int solves = 1);

  std::string_view name() const override { return "auto"; }
  std::string description() const override;  // the choice and its reason
  void set_stop(const StopToken& stop) override {
    for (LinearSolver* solver : solver_) solver->set_stop(stop);
  }
  void set_stiff_rows(const StiffRows* rows) override {
    stiff_ = rows;
    for (LinearSolver* solver : solver_) solver->set_stiff_rows(rows);
  }
  void analyze(const BlockPattern& pattern) override;
  void begin() override;
  bool factorize(const BlockSparse& H) override;
  SolveReport solve(std::span<const double> b, std::span<double> x, double tolerance) override;

  LinearSolver& chosen() { return *solver_[choice_]; }
  const LinearSolver& chosen() const { return *solver_[choice_]; }
  int64_t fallbacks() const { return fallbacks_; }  // number of replaced choices

 private:
  enum Choice { kBlockJacobi, kMultigrid, kCholesky };
  Choice cheapest(const BlockSparse& H);
  bool factorize_with_choice();
  bool fall_back();

  int64_t memory_limit_;
  int solves_;
  Cholesky cholesky_;
  ConjugateGradient block_jacobi_, multigrid_;
  std::array<LinearSolver*, 3> solver_;
  std::array<bool, 3> is_analyzed_ = {};
  const BlockPattern* pattern_ = nullptr;
  const BlockSparse* H_ = nullptr;
  const StiffRows* stiff_ = nullptr;
  CostPrediction prediction_;
  bool fits_ = false;        // whether the factor fits into memory
  double affordable_ = 0;    // block-Jacobi iterations that cost as much as a factorization, per solve
  double expected_ = 0;      // predicted block-Jacobi iterations for two digits; 0: not computed
  bool has_chosen_ = false;  // a choice was made for this pattern
  bool is_chosen_ = false;   // a choice was made for this sequence
  Choice choice_ = kBlockJacobi;
  int64_t fallbacks_ = 0;
  double cycles_ = 0, tries_ = 0;  // cycles in this sequence, and matrices that multigrid was tried on
  std::vector<char> held_;         // scratch
};

// Returns the Cholesky solver that `solver` is or has chosen, or null.
Cholesky* as_cholesky(LinearSolver& solver);

}  // namespace aspic
