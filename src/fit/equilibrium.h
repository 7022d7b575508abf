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
  double adjoint_tolerance = 1e-12;  // relative residual of those
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

  // K at x(); false: it is not positive definite, x() is no stable equilibrium.
  bool factorize();
  SolveReport solve_stiffness(std::span<const double> b, std::span<double> u);  // K u = b, u = 0 on pinned vertices
  // dx = dx/dtheta dtheta; `dtheta` holds parameters_per_tet() numbers per tet.
  void tangent(std::span<const double> dtheta, std::span<double> dx);
  // thetabar += (dx/dtheta)' xbar
  void add_adjoint(std::span<const double> xbar, std::span<double> thetabar);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aspic
