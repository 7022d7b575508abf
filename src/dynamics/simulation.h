// Advances a model in time, one minimisation per step.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/model.h"
#include "dynamics/stable_step.h"
#include "dynamics/state.h"
#include "dynamics/step_report.h"
#include "optimize/solver.h"

namespace aspic {

// Steps are divided into parts of h / 2^k as an error estimate asks for.
struct AdaptiveOptions {
  double tolerance = 0;  // error that a step may add, relative to the size of each body; 0: steps are taken whole
};

struct SimulationOptions {
  double h = 0.01;                            // time step [s]
  std::string integrator = "backward_euler";  // see integrator_names()
  AdaptiveOptions adaptive = {};
  std::string initial_guess = "best";  // see initial_guess_names()
  SolverOptions solver;
  WallClock clock = steady_seconds;  // for solver.time_budget
};

std::vector<std::string> integrator_names();
std::vector<std::string> adaptive_integrator_names();  // those whose steps can be divided

// What the integrator cannot do or has no use for: "adaptive", "initial_guess", or a member of SolverOptions.
std::optional<SolverConflict> find_conflict(const SimulationOptions& options);

class Simulation {
 public:
  // `initial` holds one entry per vertex of the model. Throws InvalidInput for an unknown name in the options, for
  // options that the integrator has no use for, and for a model that cannot be simulated: a vertex without mass in
  // dynamics, a start with infinite energy.
  Simulation(Model model, State initial, SimulationOptions options);
  explicit Simulation(Model model, SimulationOptions options = {});  // starts at rest, see at_rest()
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  // A step that the observer stops, that may not go on, or that takes longer than `time_limit` [s] of the options'
  // clock is dropped with the status `interrupted`. A limit that is not met changes no bit; within a factorisation
  // nothing is stopped.
  StepReport step(const IterationObserver& observe = {}, const Consent& go_on = {}, double time_limit = kNoTimeLimit);
  // From the next step on; both throw InvalidInput as the constructor does, and change nothing then.
  void set_solver(const SolverOptions& solver);
  void set_pins(std::vector<Pin> pins);

  const Model& model() const;
  const State& state() const;
  const SimulationOptions& options() const;
  int steps_taken() const;

  std::vector<std::string> potential_names() const;  // one per entry of StepReport::potential
  StepReport start_report() const;  // of the state at the start, as step 0: energies, det F, nothing of a solve
  double kinetic_energy() const;    // [J]
  std::vector<double> potential_energies() const;  // [J]
  TetFields tet_fields() const;
  bool is_implicit() const;                // the integrator minimises
  StableStep stable_step() const;          // at the start: what an explicit integrator can take
  std::string solver_description() const;  // the methods and what each of them chose, and why

  // Everything that the next steps depend on besides model and options; restoring continues to the same bits.
  struct Snapshot {
    State state;
    State start;  // the state at time 0, to which pins and ledger refer
    int steps_taken = 0;
    double level = 0;               // of an adaptive step: its next part has the length h / 2^level
    std::optional<State> previous;  // where the last step or part began, when that is remembered
    double outside_work = 0;  // by moving pins and targets of an explicit run, each step's as a positive number [J]
  };
  Snapshot snapshot() const;
  void restore(const Snapshot& snapshot);  // throws InvalidInput when the sizes do not fit the model

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aspic
