// One step of an integrator. An implicit one is a predicted position, a factor in front of V, and a state update.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/incremental_potential.h"
#include "dynamics/state.h"
#include "linalg/linear_solver.h"
#include "optimize/minimize.h"

namespace aspic {

// What an integrator works with.
struct StepTools {
  const Model& model;
  const Pins& pins;
  IncrementalPotential& E;
  Minimizer& minimizer;
  SearchDirection& direction;
  const MinimizeOptions& options;
  const IterationObserver& observe;
  double end_time;  // of the step [s]
};

// How a scheme relates the step's displacement to velocities, on which its energy ledger depends.
enum class Displacement {
  new_velocity,  // q_new - q = h qdot_new
  old_velocity,  // q_new - q = h qdot_old
  any,           // statics: there is no velocity
};

class Integrator {
 public:
  virtual ~Integrator() = default;
  virtual std::string_view name() const = 0;
  virtual bool is_implicit() const = 0;
  virtual bool is_static() const { return false; }
  virtual Displacement displacement() const = 0;
  // Writes the state at time + h. The terms of V and D have been told of the step.
  virtual MinimizeReport advance(const StepTools& tools, double h, State& state) = 0;
};

std::unique_ptr<Integrator> make_integrator(std::string_view name);  // throws InvalidInput for an unknown name

std::unique_ptr<Integrator> make_backward_euler();
std::unique_ptr<Integrator> make_linearly_implicit_euler();
std::unique_ptr<Integrator> make_quasi_static();
std::unique_ptr<Integrator> make_symplectic_euler();
std::unique_ptr<Integrator> make_forward_euler();

}  // namespace aspic
