#include "distributed/rank_auto.h"

#include "linalg/auto_solver.h"

namespace aspic::distributed {
namespace {

// Measured on beams: the set-up of GAMG and its iterations take as long as several hundred iterations of block-Jacobi.
constexpr double kFew = 150;          // predicted iterations for two digits
constexpr int kMaxIterations = 1500;  // of block-Jacobi

}  // namespace

RankAuto::RankAuto(const MeshShare& mesh, const Share& share, Halo& halo)
    : share_(share), halo_(halo), jacobi_(share, halo, kMaxIterations), gamg_(mesh, share, halo) {}

std::string RankAuto::description() const {
  return "conjugate gradients with block_jacobi or gamg of PETSc by predicted cost";
}

void RankAuto::analyze(const BlockPattern& pattern) {
  jacobi_.analyze(pattern);
  gamg_.analyze(pattern);
  choice_ = Choice::none;
}

void RankAuto::begin() {
  gamg_.begin();
  choice_ = Choice::none;
}

bool RankAuto::factorize(const BlockSparse& H) {
  H_ = &H;
  if (choice_ == Choice::none) {
    const UniformStiffness own = uniform_stiffness(H, share_.own(H.pattern->rows()), scratch_);
    double sums[] = {own.uniform, own.diagonal};
    share_.sum(sums);
    choice_ = predict_iterations(UniformStiffness{sums[0], sums[1]}) <= kFew ? Choice::block_jacobi : Choice::gamg;
  }
  if (choice_ == Choice::block_jacobi) return jacobi_.factorize(H);
  return gamg_.factorize(H);
}

SolveReport RankAuto::solve(std::span<const double> b, std::span<double> x, double tolerance) {
  if (choice_ == Choice::gamg) return gamg_.solve(b, x, tolerance);
  const SolveReport first = jacobi_.solve(b, x, tolerance);
  if (first.ok || first.indefinite) return first;
  choice_ = Choice::gamg;
  if (!gamg_.factorize(*H_)) return first;
  SolveReport report = gamg_.solve(b, x, tolerance);
  report.iterations += first.iterations;
  report.products += first.products;
  return report;
}

std::unique_ptr<LinearSolver> RankAuto::make_semidefinite_solver() const {
  return std::make_unique<RankCg>(share_, halo_);
}

}  // namespace aspic::distributed
