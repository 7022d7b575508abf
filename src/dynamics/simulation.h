// Advances a model in time, one minimization per step.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/integrator_facts.h"
#include "dynamics/model.h"
#include "dynamics/stable_step.h"
#include "dynamics/state.h"
#include "dynamics/step_report.h"
#include "optimize/solver.h"

namespace aspic {

// Adaptive time steps: a step is divided into substeps of h / 2^k according to an error estimate.
struct AdaptiveOptions {
  double tolerance = 0;  // error per step relative to the size of each body; 0: no substeps
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
std::vector<std::string> adaptive_integrator_names();  // those with an error estimate

// Returns an option that the integrator does not support: "adaptive", "initial_guess", or a member of SolverOptions.
std::optional<SolverConflict> find_conflict(const SimulationOptions& options);

class Simulation {
 public:
  // `initial` has 3 numbers per vertex of the model. Throws InvalidInput for an unknown name in the options, for
  // options that the integrator does not support, and for a model that cannot be simulated: a vertex without mass in
  // dynamics, a start with infinite energy.
  Simulation(Model model, State initial, SimulationOptions options);
  explicit Simulation(Model model, SimulationOptions options = {});  // starts at rest, see at_rest()
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  // Takes one time step. If `stop` stops it, by a request or its deadline, the step is dropped: the state stays and the
  // status is `interrupted`. A token that does not stop the step changes no bit of it. Factorizations do not poll it.
  StepReport step(const IterationObserver& observe = {}, const StopToken& stop = {});
  // Change the subsequent steps. Both throw InvalidInput as the constructor does, and then change nothing.
  void set_solver(const SolverOptions& solver);
  void set_pins(std::vector<Pin> pins);

  const Model& model() const;
  const State& state() const;
  const SimulationOptions& options() const;
  int steps_taken() const;

  std::vector<std::string> potential_names() const;  // one per entry of StepReport::potential
  StepReport start_report() const;                   // step 0: energies and det F of the initial state
  double kinetic_energy() const;                     // [J]
  std::vector<double> potential_energies() const;    // [J]
  TetFields tet_fields() const;
  const IntegratorFacts& integrator() const;
  StableStep stable_step() const;          // of an explicit integrator, at the initial state
  std::string solver_description() const;  // the methods and their choices with reasons, for logs

  // Everything that subsequent steps depend on besides model and options. Steps after restore() have the same bits.
  struct Snapshot {
    State state;
    State start;  // the state at time 0, to which pins and ledger refer
    int steps_taken = 0;
    double level = 0;                          // the next substep has the length h / 2^level
    std::optional<State> previous;             // at the start of the last step or substep, if the integrator keeps it
    std::optional<double> obstacle_time = {};  // empty: that of the state
    double outside_work = 0;  // sum over steps of |work of moving pins and targets|, explicit schemes [J]
  };
  Snapshot snapshot() const;
  double obstacle_time() const;            // at which obstacles are: that of the state unless they were blocked [s]
  void restore(const Snapshot& snapshot);  // throws InvalidInput if the sizes do not match the model

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aspic
