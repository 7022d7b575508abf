// Time integrators. An implicit stage consists of a predicted position, a factor of V, and a state update.
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

// Arguments of a minimization.
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

// Arguments of a step.
struct StepTools : SolveTools {
  const State& start;     // start of the step
  const State* previous;  // start of the previous step; null if unknown
  double h, end_time;     // length and end of the step [s]
  // Times of the obstacles at the start and the end of the step; equal if the step is dropped [s].
  double obstacle_start = 0, obstacle_end = 0;
  bool is_dropped = false;  // the state stays at the start of the step
};

enum class ResidualBound { none, threshold };  // bound that a solve guarantees

// Forces of a step, as weighted sums over its stages. r = M a + G + C is the residual of the solves on free vertices
// and the reaction of the pins on pinned vertices.
struct StepForces {
  std::vector<double> gradient, damping;  // G = sum w dV/dx and C = sum w dD/dx [N]
  std::vector<double> rims;               // share of the rims of pressures in C [N]
  std::vector<double> acceleration;       // a = sum w acc [m/s^2]; zero in statics
  // For each part of the objective (HasParts): the threshold of |r| (0 without a solve) and the rounding error of |r|
  // [N].
  std::vector<double> thresholds, round_offs;

  void reset(size_t size);
  // Adds the forces of all terms at x.
  void add(const IncrementalPotential& E, double weight, Positions x, std::span<const double> acc, Work& work);
  // Adds threshold and rounding error of a solve that ended at x.
  void add_bounds(const SolveTools& tools, ResidualBound bound, double weight, Positions x);
  void add_round_off(const IncrementalPotential& E, double round_off);  // adds to every part [N]

 private:
  void resize_bounds(const IncrementalPotential& E);
};

// Solves of a step: counts are sums over its stages; the status is the worst one.
struct StepSolve {
  MinimizeReport work = {.status = Status::converged};
  double decrement = 0;  // maximum over the minimizations [J]
  int passes = 0;        // evaluations of lagged coefficients, maximum over the stages
  InitialGuess guess = InitialGuess::none;

  // Returns false if the step cannot continue from this stage.
  bool add(const MinimizeReport& stage);
};

class Integrator {
 public:
  explicit Integrator(const IntegratorFacts& facts) : facts_(facts) {}
  virtual ~Integrator() = default;
  const IntegratorFacts& facts() const { return facts_; }
  // Sets the velocities of pinned vertices in the initial state. The default is the mean velocity of the pins in the
  // first step.
  virtual void set_pin_velocity(const Pins& pins, double h, State& state) const;
  // Writes the state at the end of the step and its forces.
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
std::unique_ptr<Integrator> make_bdf2();

}  // namespace aspic
