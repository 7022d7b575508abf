#include "ranks/rank_auto.h"

#include "linalg/auto_solver.h"
#include "ranks/petsc_solver.h"
#include "ranks/rank_cg.h"
#include "ranks/rank_multigrid.h"

namespace aspic::distributed {
namespace {

constexpr double kFew = 60;       // predicted iterations for two digits that cost as much as multigrid
constexpr int kMaxJacobi = 1500;  // iterations before GAMG
constexpr int kMaxMultigrid = 500;
constexpr int kMaxRanks = 256;  // every rank factorizes the coarse matrix of all; an estimate

}  // namespace

std::string RankAuto::description() const { return solver_ ? "auto: " + solver_->description() : "auto"; }

void RankAuto::analyze(const BlockPattern& pattern) {
  pattern_ = &pattern;
  solver_.reset();
  choice_ = made_ = Choice::none;
}

void RankAuto::begin() {
  choice_ = Choice::none;
  if (solver_) solver_->begin();
}

RankAuto::Choice RankAuto::cheapest(const BlockSparse& H) {
  const UniformStiffness own = uniform_stiffness(H, share_.own(H.pattern->rows()), scratch_);
  double sums[] = {own.uniform, own.diagonal};
  share_.sum(sums);
  if (predict_iterations(UniformStiffness{sums[0], sums[1]}) <= kFew) return Choice::block_jacobi;
  return mesh_.ranks() <= kMaxRanks ? Choice::multigrid : Choice::gamg;
}

bool RankAuto::factorize_with(Choice choice) {
  choice_ = choice;
  if (made_ != choice) {
    solver_.reset();
    if (choice == Choice::block_jacobi) {
      solver_ = std::make_unique<RankCg>(share_, halo_, kMaxJacobi);
    } else if (choice == Choice::multigrid) {
      solver_ =
          std::make_unique<RankCg>(share_, halo_, std::make_unique<RankMultigrid>(mesh_, share_, halo_), kMaxMultigrid);
    } else {
      solver_ = std::make_unique<PetscSolver>(mesh_, share_, halo_);
    }
    solver_->analyze(*pattern_);
    made_ = choice;
  }
  if (auto* gamg = dynamic_cast<PetscSolver*>(solver_.get())) gamg->set_positions(x_);
  return solver_->factorize(*H_);
}

bool RankAuto::factorize(const BlockSparse& H) {
  H_ = &H;
  return factorize_with(choice_ == Choice::none ? cheapest(H) : choice_);
}

SolveReport RankAuto::solve(std::span<const double> b, std::span<double> x, double tolerance) {
  const SolveReport first = solver_->solve(b, x, tolerance);
  if (first.ok || first.indefinite || choice_ == Choice::gamg) return first;
  if (!factorize_with(Choice::gamg)) return first;
  SolveReport report = solver_->solve(b, x, tolerance);
  report.iterations += first.iterations;
  report.products += first.products;
  return report;
}

std::unique_ptr<LinearSolver> RankAuto::make_semidefinite_solver() const {
  return std::make_unique<RankCg>(share_, halo_);
}

}  // namespace aspic::distributed
