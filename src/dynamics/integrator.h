// One step of an integrator. An implicit stage is a predicted position, a factor in front of V, and a state update.
#pragma once
#include <memory>
#include <string_view>
#include <vector>

#include "dynamics/guesser.h"
#include "dynamics/incremental_potential.h"
#include "dynamics/integrator_facts.h"
#include "dynamics/state.h"
#include "dynamics/step_report.h"
#include "linalg/linear_solver.h"
#include "optimize/minimize.h"

namespace aspic {

// What minimizations work with.
struct SolveTools {
  const Model& model;
  const Pins& pins;
  IncrementalPotential& E;
  Minimizer& minimizer;
  SearchDirection& direction;
  const MinimizeOptions& options;
  const IterationObserver& observe;
  InitialGuess guess;
};

// What an integrator works with.
struct StepTools : SolveTools {
  const State& start;     // of the step
  const State* previous;  // where the step before started; null when none is known
  double h, end_time;     // of the step [s]
};

enum class Asked { nothing, residual };  // of a solve

// What acted in a step, weighted over its stages so that r = M a + G + C is what the solves left over, and on pinned
// vertices the force of the pins.
struct StepForces {
  std::vector<double> gradient, damping;  // G = sum w dV/dx and C = sum w dD/dx [N]
  std::vector<double> acceleration;       // a = sum w acc [m/s^2]; zero in statics
  // Of each part of the objective (Objective::part_count): the |r| that was asked for, 0 without a solve, and the part
  // of |r| that is round-off [N].
  std::vector<double> thresholds, round_offs;

  void reset(size_t size);
  // Of the terms as they are told, at x.
  void add(const IncrementalPotential& E, double weight, Positions x, std::span<const double> acc, Work& work);
  // Of a solve that ended at x.
  void add_bounds(const SolveTools& tools, Asked asked, double weight, Positions x);
  void add_round_off(const IncrementalPotential& E, double round_off);  // to that of every part [N]

 private:
  void resize_bounds(const IncrementalPotential& E);
};

// How a step went: counts are sums over its stages, the status is the worst of them.
struct StepSolve {
  MinimizeReport work = {.status = Status::converged};
  double decrement = 0;  // the largest of its stages [J]
  InitialGuess guess = InitialGuess::none;

  // False when there is nothing to go on from.
  bool add(const MinimizeReport& stage);
};

class Integrator {
 public:
  explicit Integrator(const IntegratorFacts& facts) : facts_(facts) {}
  virtual ~Integrator() = default;
  const IntegratorFacts& facts() const { return facts_; }
  // Gives the pinned vertices of the first state the velocities of their pins, as the scheme sees them: here those with
  // which they reach their places at the end of the first step.
  virtual void set_pin_velocity(const Pins& pins, double h, State& state) const;
  // Writes the state at the end of the step, and what acted in it.
  virtual StepSolve advance(const StepTools& tools, State& end, StepForces& forces) = 0;

 private:
  IntegratorFacts facts_;
};

std::unique_ptr<Integrator> make_integrator(std::string_view name);  // throws InvalidInput for an unknown name

std::unique_ptr<Integrator> make_backward_euler();
std::unique_ptr<Integrator> make_linearly_implicit_euler();
std::unique_ptr<Integrator> make_quasi_static();
std::unique_ptr<Integrator> make_symplectic_euler();  // printed as "Forward Euler" on the lecture's slide
std::unique_ptr<Integrator> make_forward_euler();
std::unique_ptr<Integrator> make_midpoint();
std::unique_ptr<Integrator> make_trapezoid();
std::unique_ptr<Integrator> make_tr_bdf2();
std::unique_ptr<Integrator> make_bdf2();
std::unique_ptr<Integrator> make_rk4();

}  // namespace aspic
