// Advances a model in time, with one minimization per step.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/integrator_facts.h"
#include "dynamics/mesh_error.h"
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
  AdaptiveOptions adaptive = {};              // substeps; default: none
  std::string initial_guess = "best";         // see initial_guess_names()
  SolverOptions solver;                       // minimization of each step
  WallClock clock = steady_seconds;           // for solver.time_budget
};

// Returns the names for SimulationOptions::integrator, in the order of help texts.
std::vector<std::string> integrator_names();
// Returns the integrators that support AdaptiveOptions: all but multistep and static ones.
std::vector<std::string> adaptive_integrator_names();

// Returns an option that the integrator does not support: "adaptive", "initial_guess", or a member of SolverOptions.
std::optional<SolverConflict> find_conflict(const SimulationOptions& options);

class Simulation {
 public:
  // `initial` has 3 entries per row of the model. Throws InvalidInput for an unknown name in the options, for
  // options that the integrator does not support, and for an invalid model: a vertex without mass in dynamics, or
  // infinite initial energy.
  Simulation(Model model, State initial, SimulationOptions options);
  explicit Simulation(Model model, SimulationOptions options = {});  // starts at rest, see at_rest()
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  // Advances by one time step. If `stop` ends it, by a request or its deadline, the step is dropped: the state is
  // unchanged and the status is `interrupted`. A token that does not end the step does not affect the result.
  // Factorizations do not poll the token.
  StepReport step(const IterationObserver& observe = {}, const StopToken& stop = {});
  // These change the subsequent steps. They throw InvalidInput like the constructor, and then change nothing.
  // `solver` replaces all options of the minimization.
  void set_solver(const SolverOptions& solver);
  // `direction` replaces that of the solver options until set_solver(). The integrator must minimize, and not in a
  // single Newton iteration.
  void set_direction(std::unique_ptr<SearchDirection> direction);
  // `pins` replaces all pins of the model. Their motions refer to the state at time 0.
  void set_pins(std::vector<Pin> pins);

  // The references are valid until this is destroyed or assigned to.
  const Model& model() const;  // with the pins of set_pins()
  const State& state() const;  // after the last step
  // Hash of the state and its internal variables, see state_hash(). These are in the user's order of tets.
  std::uint64_t state_hash() const;
  const SimulationOptions& options() const;  // with the solver of set_solver()
  int steps_taken() const;                   // since time 0

  std::vector<std::string> potential_names() const;  // one per entry of StepReport::potential
  StepReport start_report() const;                   // step 0: energies and det F of the initial state
  double kinetic_energy() const;                     // of the current state [J]
  std::vector<double> potential_energies() const;    // of the current state, one per potential_names() [J]
  // Returns the forces of the pins on the vertices in the last step or substep; NaN if no step was taken [N].
  std::vector<double> reactions() const;
  MeshErrorEstimate mesh_error(const StopToken& stop = {}) const;  // estimate at the current state
  TetFields tet_fields() const;               // one value per tet at the current state, in the model's order
  const IntegratorFacts& integrator() const;  // properties of the selected integrator
  StableStep stable_step() const;             // for an explicit integrator, at the initial state
  std::string solver_description() const;     // methods and choices with their reasons, for logs

  // Everything besides model and options that subsequent steps depend on. Steps after restore() are bit-reproducible.
  struct Snapshot {
    State state;                               // after steps_taken steps
    State start;                               // state at time 0, which pins and ledger refer to
    int steps_taken = 0;                       // since time 0
    double level = 0;                          // the next substep has the length h / 2^level
    std::optional<State> previous;             // start of the last step or substep, if the integrator keeps it
    std::optional<double> obstacle_time = {};  // empty: the time of the state
    double outside_work = 0;  // sum over steps of |work of moving pins and targets|, for explicit schemes [J]
  };
  Snapshot snapshot() const;               // of the current state
  double obstacle_time() const;            // time of the obstacles [s]: that of the state unless they were blocked
  void restore(const Snapshot& snapshot);  // throws InvalidInput if the sizes do not match the model

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aspic
