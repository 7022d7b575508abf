// Linear systems of Newton's method by PETSc: conjugate gradients with smoothed aggregation (GAMG).
#pragma once
#include <memory>
#include <vector>

#include "linalg/linear_solver.h"
#include "ranks/halo.h"

namespace aspic::distributed {

// Starts MPI and PETSc, and ends them. Options of PETSc come from this program alone: neither from PETSC_OPTIONS nor
// from a file.
class PetscSession {
 public:
  PetscSession();
  ~PetscSession();
  PetscSession(const PetscSession&) = delete;
  PetscSession& operator=(const PetscSession&) = delete;
};

// The matrix and the hierarchy are made for the first matrix of a sequence, with the rigid motions of the positions
// that set_positions() has set. Later matrices of the sequence keep the preconditioner, or its prolongators alone if
// the iterations grow. Each sequence starts from nothing, so that it does not depend on earlier ones. Requires a
// PetscSession.
class PetscSolver : public LinearSolver {
 public:
  // All must outlive this.
  PetscSolver(const MeshShare& mesh, const Share& share, Halo& halo);
  ~PetscSolver() override;

  std::string_view name() const override { return "gamg"; }
  std::string description() const override { return "conjugate gradients with gamg of PETSc"; }
  // Positions of the local vertices at the next begin(), 3 per vertex [m].
  void set_positions(std::span<const double> x);
  void analyze(const BlockPattern& pattern) override;
  void begin() override;
  bool factorize(const BlockSparse& H) override;  // false: PETSc cannot set up the preconditioner
  SolveReport solve(std::span<const double> b, std::span<double> x, double tolerance) override;
  std::unique_ptr<LinearSolver> make_semidefinite_solver() const override;

 private:
  struct Objects;  // those of PETSc

  const MeshShare& mesh_;
  const Share& share_;
  Halo& halo_;
  std::vector<double> x_;
  std::unique_ptr<Objects> petsc_;
};

}  // namespace aspic::distributed
