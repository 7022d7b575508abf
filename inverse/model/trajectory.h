// The motion of a body by backward Euler, and the gradient of a function of that motion with respect to the material of
// every tet, density, damping and the initial state: one linear solve per step, backward in time.
//   step      g(q1; q0, v0) = M (q1 - q0 - h v0) + h^2 (dV/dx(q1) + dD/dx(q1; q0)) = 0,  v1 = (q1 - q0) / h
//   adjoint   H mu = qbar1 + vbar1 / h,  H = M + h^2 (V'' + D''),  thetabar -= mu' dg/dtheta,
//             vbar0 = h M mu,  qbar0 = M mu - h^2 (d2D/dx dq0)' mu - vbar1 / h
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/stop_token.h"
#include "dynamics/model.h"
#include "dynamics/state.h"

namespace aspic {

struct TrajectoryOptions {
  double h = 0.01;  // [s]
  int steps = 100;
  std::string integrator = "backward_euler";  // the only one with a gradient
  double tolerance = 1e-9;  // tolerance of the residual of each step, relative to the balancing forces
  int max_iterations = 200;
  std::string linear = "auto";      // solver of Newton's steps
  std::string adjoint = "auto";     // solver of the adjoint steps, see linear_solver_names()
  double adjoint_tolerance = 1e-8;  // relative residual of adjoint solves; the gradient error is a few times larger
  int stored_states = 100;          // maximum number at a time; steps between them are repeated
  StopToken stop = {};              // polled in every step
};

// The contribution of the state at one point of the motion, 0 (the start) to `steps`, to the function. A simulation
// calls it once per point, in ascending order, with empty spans, and adds up the returned values. A gradient then calls
// it once more per point, in descending order: it must add its derivatives to qbar and vbar, 3 numbers per vertex.
using TrajectoryObjective = std::function<double(int point, const State& state, std::span<double> qbar,  //
                                                 std::span<double> vbar)>;

struct TrajectoryGradient {
  std::vector<double> elastic;               // with respect to mu, lambda, ... of every tet, as in ElasticParameters
  std::vector<double> density;               // value per tet; empty if the load "gravity" is not the weight of the body
  std::vector<std::vector<double>> damping;  // with respect to the coefficients of each term of Model::damping
  std::vector<double> q, qdot;               // with respect to the initial state; 0 at pinned vertices
};

struct TrajectoryReport {
  bool ok = false;
  std::string message;                                  // the reason for a failure
  double value = 0;                                     // value of the objective
  long steps = 0;                                       // forward, including repeated ones
  long newton_iterations = 0, factorizations = 0;       // forward
  long adjoint_solves = 0, adjoint_factorizations = 0;  // backward; computed factors or preconditioners
  long adjoint_iterations = 0;                          // of conjugate gradients
};

class Trajectory {
 public:
  // Throws InvalidInput for other integrators and for damping terms without derivatives.
  Trajectory(Model model, State start, const TrajectoryOptions& options);
  ~Trajectory();
  Trajectory(Trajectory&&) noexcept;

  const Model& model() const;
  Model release_model() &&;                                             // the trajectory must not be used afterwards
  void set_parameters(std::span<const MaterialParameters> parameters);  // one per tet
  void set_start(const State& start);

  TrajectoryReport simulate(const TrajectoryObjective& objective);
  TrajectoryReport differentiate(const TrajectoryObjective& objective, TrajectoryGradient& gradient);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Returns the acceleration [m/s^2] of the load 'gravity', zero without such a load; nothing if its forces are not the
// weight of the vertex masses. `q`: any positions.
std::optional<Vec3d> gravity_of(const Model& model, std::span<const double> q);

}  // namespace aspic
