#include "ranks/petsc_solver.h"

#include <petscksp.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>
#include <utility>

#include "ranks/mpi_ranks.h"
#include "ranks/petsc_matrix.h"
#include "ranks/rank_cg.h"

namespace aspic::distributed {
namespace {

// All options of the solver. Defaults of PETSc change between its versions.
constexpr const char* kOptions[][2] = {
    {"-ksp_type", "cg"},
    {"-ksp_norm_type", "unpreconditioned"},
    {"-pc_type", "gamg"},
    {"-pc_gamg_type", "agg"},
    {"-pc_gamg_agg_nsmooths", "1"},
    {"-pc_gamg_threshold", "0"},  // the explicit zeros of pinned rows are no couplings
    {"-pc_gamg_aggressive_coarsening", "1"},
    {"-pc_gamg_reuse_interpolation", "true"},
    {"-pc_gamg_repartition", "false"},
    {"-pc_gamg_process_eq_limit", "50"},
    {"-pc_gamg_coarse_eq_limit", "50"},
    {"-pc_gamg_esteig_ksp_type", "cg"},
    {"-pc_gamg_esteig_ksp_max_it", "10"},
    {"-pc_mg_cycle_type", "v"},
    {"-mg_levels_ksp_type", "chebyshev"},
    {"-mg_levels_ksp_max_it", "2"},
    {"-mg_levels_pc_type", "sor"},
    {"-mg_levels_pc_sor_diagonal_shift", "1e-12"},  // aggregates of few vertices have fewer than six modes
    {"-mg_coarse_ksp_type", "preonly"},
    {"-mg_coarse_pc_type", "bjacobi"},
    {"-mg_coarse_sub_pc_type", "lu"},
};

constexpr double kTolerable = 1.5;  // growth of the iterations per digit with a preconditioner of an earlier matrix

void set_options() {
  for (const auto& [name, value] : kOptions) check(PetscOptionsSetValue(nullptr, name, value));
  // PETSc's own product of several ranks adds in the order of arrival, so that results differ from run to run.
  int ranks = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  if (ranks > 1) check(PetscOptionsSetValue(nullptr, "-matptap_via", "hypre"));
}

// PETSc counts what its own functions send.
Traffic traffic_of_petsc() {
  return {petsc_send_ct + petsc_isend_ct, petsc_send_len + petsc_isend_len, petsc_allreduce_ct + petsc_gather_ct};
}

}  // namespace

PetscSession::PetscSession() {
  unsetenv("PETSC_OPTIONS");
  char name[] = "aspic-mpi", no_signals[] = "-no_signal_handler", no_file[] = "-skip_petscrc";
  char* arguments[] = {name, no_signals, no_file, nullptr};
  int count = 3;
  char** values = arguments;
  check(PetscInitialize(&count, &values, nullptr, nullptr));
  check(PetscPushErrorHandler(PetscReturnErrorHandler, nullptr));  // check() makes exceptions of errors
  set_options();
}

PetscSession::~PetscSession() { PetscFinalize(); }

struct PetscSolver::Objects {
  RowsOfRank rows;
  bool is_new = true;  // no matrix of this sequence yet
  // Iterations per digit of the first and the last solve with this preconditioner; 0: none.
  double first_rate = 0, rate = 0;
  Mat A = nullptr;
  KSP ksp = nullptr;
  Vec x = nullptr, b = nullptr;

  // Destroying them may wait for other ranks, which an exception on this rank alone must not.
  ~Objects() {
    if (std::uncaught_exceptions() == 0) clear();
  }
  void clear() {
    KSPDestroy(&ksp);
    MatDestroy(&A);
    VecDestroy(&x);
    VecDestroy(&b);
  }
  // A failed solve renews the preconditioner.
  void note_rate(const SolveReport& report) {
    rate = report.ok ? report.iterations / std::max(1e-3, -std::log10(report.relative_residual)) : 0;
    if (first_rate == 0) first_rate = rate;
  }
  void make(const MeshShare& mesh, std::span<const double> positions) {
    clear();
    first_rate = rate = 0;
    A = rows.make_matrix();
    check(MatCreateVecs(A, &x, &b));
    set_rigid_motions(mesh, positions, x, A);
    srand48(1);  // the random vectors of GAMG come from one generator of the process
    check(KSPCreate(PETSC_COMM_WORLD, &ksp));
    check(KSPSetFromOptions(ksp));
  }
};

PetscSolver::PetscSolver(const MeshShare& mesh, const Share& share, Halo& halo)
    : mesh_(mesh), share_(share), halo_(halo), petsc_(std::make_unique<Objects>()) {}

PetscSolver::~PetscSolver() = default;

void PetscSolver::set_positions(std::span<const double> x) { x_.assign(x.begin(), x.end()); }

void PetscSolver::analyze(const BlockPattern& pattern) {
  petsc_->rows = RowsOfRank(mesh_, pattern);
  petsc_->is_new = true;
}

void PetscSolver::begin() { petsc_->is_new = true; }

bool PetscSolver::factorize(const BlockSparse& H) {
  if (std::exchange(petsc_->is_new, false)) petsc_->make(mesh_, x_);
  petsc_->rows.fill(H, petsc_->A);
  const bool is_kept = petsc_->rate > 0 && petsc_->rate <= kTolerable * petsc_->first_rate;
  if (!is_kept) petsc_->first_rate = petsc_->rate = 0;
  check(KSPSetReusePreconditioner(petsc_->ksp, is_kept ? PETSC_TRUE : PETSC_FALSE));
  check(KSPSetOperators(petsc_->ksp, petsc_->A, petsc_->A));
  const PetscErrorCode error = KSPSetUp(petsc_->ksp);
  if (share_.max(error == PETSC_ERR_MEM) > 0) check(PETSC_ERR_MEM);
  if (share_.max(error) == 0) return true;
  petsc_->is_new = true;  // such as negative bounds of eigenvalues
  return false;
}

SolveReport PetscSolver::solve(std::span<const double> b, std::span<double> x, double tolerance) {
  constexpr int kMaxIterations = 10'000;
  const size_t own = 3 * static_cast<size_t>(mesh_.own());
  copy_to(b.first(own), petsc_->b);
  check(KSPSetTolerances(petsc_->ksp, tolerance, 0, PETSC_DEFAULT, kMaxIterations));
  const Traffic before = traffic_of_petsc();
  check(KSPSolve(petsc_->ksp, petsc_->b, petsc_->x));
  halo_.traffic().linear += traffic_of_petsc() - before;
  copy_from(petsc_->x, x.first(own));
  halo_.update(x);

  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  PetscInt iterations = 0;
  PetscReal residual = 0, b_norm = 0;
  check(KSPGetConvergedReason(petsc_->ksp, &reason));
  check(KSPGetIterationNumber(petsc_->ksp, &iterations));
  check(KSPGetResidualNorm(petsc_->ksp, &residual));
  check(VecNorm(petsc_->b, NORM_2, &b_norm));
  const bool is_indefinite = reason == KSP_DIVERGED_INDEFINITE_MAT || reason == KSP_DIVERGED_INDEFINITE_PC;
  // All ranks decide by the numbers of rank 0.
  double result[] = {reason > 0 ? 1.0 : 0.0, is_indefinite ? 1.0 : 0.0, b_norm > 0 ? residual / b_norm : 0};
  broadcast(result);
  SolveReport report;
  report.ok = result[0] > 0;
  report.indefinite = result[1] > 0;
  report.relative_residual = result[2];
  report.iterations = report.products = report.cycles = iterations;
  halo_.traffic().linear.iterations += iterations;
  petsc_->note_rate(report);
  return report;
}

std::unique_ptr<LinearSolver> PetscSolver::make_semidefinite_solver() const {
  return std::make_unique<RankCg>(share_, halo_);
}

}  // namespace aspic::distributed
