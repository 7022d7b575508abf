// The motion of a body over implicit time steps, and the gradient of a function of that motion with respect to the
// material of every tet, density, damping and the initial state: one linear solve per step, backwards in time.
//   step      g(q1; q0, v0) = M (q1 - q0 - h v0) + h^2 (dV/dx(q1) + dD/dx(q1; q0)) = 0,  v1 = (q1 - q0) / h
//   adjoint   H mu = qbar1 + vbar1 / h,  H = M + h^2 (V'' + D''),  thetabar -= mu' dg/dtheta,
//             vbar0 = h M mu,  qbar0 = M mu - h^2 (d2D/dx dq0)' mu - vbar1 / h
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dynamics/model.h"
#include "dynamics/state.h"

namespace aspic {

struct TrajectoryOptions {
  double h = 0.01;  // [s]
  int steps = 100;
  std::string integrator = "backward_euler";  // the only one with a gradient so far
  double tolerance = 1e-9;                    // of each step's residual, relative to the forces that balance
  int max_iterations = 200;
  std::string linear = "auto";      // solver of Newton's steps
  std::string adjoint = "auto";     // solver of the steps backwards, see linear_solver_names()
  double adjoint_tolerance = 1e-8;  // relative residual of those; errors of the gradient are some times larger
  int stored_states = 100;          // at a time; steps between them are repeated
};

// The part of a state in what is minimized, for point 0 (the start) to `steps`: returns its value and adds its
// derivatives to qbar and vbar, 3 numbers per vertex; empty when only the value is wanted. It may be called for the
// same point more than once.
using TrajectoryObjective = std::function<double(int point, const State& state, std::span<double> qbar,  //
                                                 std::span<double> vbar)>;

struct TrajectoryGradient {
  std::vector<double> elastic;               // to mu, lambda, ... of every tet: ElasticParameters
  std::vector<double> density;               // of every tet; empty where it is not known, see density_words
  std::string density_words;                 // why not
  std::vector<std::vector<double>> damping;  // to Damping's coefficients, of each term of Model::damping
  std::vector<double> q, qdot;               // to the initial state; pinned vertices have no position to choose
};

struct TrajectoryReport {
  bool ok = false;
  std::string failure;                                  // in words
  double value = 0;                                     // of the objective
  long steps = 0;                                       // forward, with those that are repeated
  long newton_iterations = 0, factorizations = 0;       // forward
  long adjoint_solves = 0, adjoint_factorizations = 0;  // backwards; factors or preconditioners made
  long adjoint_iterations = 0, adjoint_products = 0;    // of conjugate gradients; products with H
  double forward_seconds = 0, adjoint_seconds = 0;      // wall time
};

class Trajectory {
 public:
  // Throws InvalidInput for what has no gradient: other integrators, terms of damping without derivatives.
  Trajectory(Model model, State start, const TrajectoryOptions& options);
  ~Trajectory();
  Trajectory(Trajectory&&) noexcept;

  const Model& model() const;
  void set_parameters(std::span<const MaterialParameters> parameters);  // one per tet
  void set_start(const State& start);

  TrajectoryReport simulate(const TrajectoryObjective& objective);
  TrajectoryReport differentiate(const TrajectoryObjective& objective, TrajectoryGradient& gradient);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aspic
