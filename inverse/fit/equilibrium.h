// A body at rest under a load, x(theta) = argmin V(x; theta) over the free vertices, and its derivatives:
//   tangent   K dx = -d(grad V)/dtheta dtheta
//   adjoint   K mu = xbar,  thetabar = -mu' d(grad V)/dtheta        K = V''(x), true and unprojected
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dynamics/model.h"
#include "linalg/linear_solver.h"
#include "optimize/minimize.h"

namespace aspic {

struct EquilibriumOptions {
  double tolerance = 1e-9;           // of the residual force, relative to the forces that balance
  int max_iterations = 200;          // of Newton's method
  std::string linear = "auto";       // solver of Newton's steps
  std::string adjoint = "auto";      // solver of tangents and adjoints, see linear_solver_names()
  int solves = 20;                   // of those per linearization, roughly; for "auto"
  double adjoint_tolerance = 1e-11;  // relative residual of those; above what round-off leaves
};

class Equilibrium {
 public:
  // The model's pins hold (at time 0) from the start `x`, 3 per vertex [m]. Terms of V that follow a load are changed
  // by their owner, between solves.
  Equilibrium(Model model, std::vector<double> x, const EquilibriumOptions& options = {});
  ~Equilibrium();
  Equilibrium(Equilibrium&&) noexcept;

  const Model& model() const;
  Model& model();
  int parameters_per_tet() const;  // mu, lambda and the material's own: TetElasticity::parameter_count()
  void set_parameters(std::span<const MaterialParameters> parameters);  // one per tet
  // Solves from x(). When that fails, x() is what it was before.
  MinimizeReport solve(const IterationObserver& observe = {});
  std::span<const double> x() const;
  void set_x(std::span<const double> x);

  // Linearizes: makes K at x(), for the parameters in force. False: it is not positive definite, so x() is no stable
  // equilibrium, or it cannot be factorized; there are no derivatives then. What follows belongs to this point until
  // the next linearization, whatever is solved between.
  bool factorize();
  std::span<const double> linearized_x() const;                                 // empty: there are no derivatives
  SolveReport solve_stiffness(std::span<const double> b, std::span<double> u);  // K u = b, u = 0 on pinned vertices
  // dx = dx/dtheta dtheta; `dtheta` holds parameters_per_tet() numbers per tet.
  SolveReport tangent(std::span<const double> dtheta, std::span<double> dx);
  // thetabar += (dx/dtheta)' xbar
  SolveReport add_adjoint(std::span<const double> xbar, std::span<double> thetabar);

  const std::string& failure() const;      // of the last solve() or factorize() that failed, in words
  std::string solver_description() const;  // of tangents and adjoints: what was chosen, and why

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aspic
