// A body at rest under a load, x(theta) = argmin V(x; theta) over the free vertices, and its derivatives:
//   tangent   K dx = -d(grad V)/dtheta dtheta
//   adjoint   K mu = xbar,  thetabar = -mu' d(grad V)/dtheta        K = V''(x), true and unprojected
// With friction, grad V includes its forces with normal forces at x. Then K has a part C that is not symmetric (see
// LaggedProduct); K is solved by iterations u := S^-1 (b - C u), where S = K - C.
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
  double tolerance = 1e-9;           // tolerance of the residual force, relative to the balancing forces
  int max_iterations = 200;          // maximum iterations of Newton's method
  std::string linear = "auto";       // solver of Newton steps
  std::string adjoint = "auto";      // solver of tangents and adjoints, see linear_solver_names()
  int solves = 20;                   // approximate number of those per linearization, for "auto"
  double adjoint_tolerance = 1e-11;  // relative residual of those; above the round-off floor
};

class Equilibrium {
 public:
  // The model's pins hold (at time 0) from the initial guess `x`, 3 per vertex [m]. The owner of terms of V with
  // variable loads changes them between solves.
  Equilibrium(Model model, std::vector<double> x, const EquilibriumOptions& options = {});
  ~Equilibrium();
  Equilibrium(Equilibrium&&) noexcept;

  const Model& model() const;
  Model& model();
  int parameters_per_tet() const;  // mu, lambda and the material's own: TetElasticity::parameter_count()
  void set_parameters(std::span<const MaterialParameters> parameters);  // one per tet
  // Solves from x(). On failure x() is unchanged.
  MinimizeReport solve(const IterationObserver& observe = {});
  std::span<const double> x() const;
  void set_x(std::span<const double> x);

  // Linearizes at x() with the current parameters. Returns false if K is not positive definite (x() is not a stable
  // equilibrium) or cannot be factorized; then there are no derivatives. They remain valid for this point until the
  // next linearization, even after further solves.
  bool factorize();
  std::span<const double> linearized_x() const;  // empty if there are no derivatives
  // K u = b, or K' u = b; u = 0 on pinned vertices
  SolveReport solve_stiffness(std::span<const double> b, std::span<double> u, bool is_transposed = false);
  // dx = dx/dtheta dtheta; `dtheta` holds parameters_per_tet() numbers per tet.
  SolveReport tangent(std::span<const double> dtheta, std::span<double> dx);
  // thetabar += (dx/dtheta)' xbar
  SolveReport add_adjoint(std::span<const double> xbar, std::span<double> thetabar);

  // Forces that pins with a motion need: g += dV/dx at x(), 3 per vertex [N]. It is 0 at free vertices.
  void add_forces(std::span<double> g) const;
  // Their change along a tangent, with all rows of K: dg = K dx + d(grad V)/dtheta dtheta; an empty dtheta is 0. Both
  // require a linearization of a model whose pins move.
  void force_tangent(std::span<const double> dtheta, std::span<const double> dx, std::span<double> dg);
  // xbar += K gbar, thetabar += gbar' d(grad V)/dtheta, for gbar that is 0 at free vertices
  void add_force_transposed(std::span<const double> gbar, std::span<double> xbar, std::span<double> thetabar);

  const std::string& failure() const;      // message of the last failed solve() or factorize()
  std::string solver_description() const;  // choice for tangents and adjoints, and its reason

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aspic
