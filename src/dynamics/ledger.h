// Energy balance of a step. With dx = q_new - q_old, the effective forces G and C of the step and its effective
// acceleration a (see StepForces),
//   r = M a + G + C
// is the reaction of the pins on pinned vertices and the residual of the solves on free vertices, and
//   dT + dV = reaction . dx + (work of moving targets and obstacles) - C . dx - numerical_loss + residual . dx
// holds exactly, where the loss of the integrator itself is
//   numerical_loss = (a' M dx - dT) + G . dx - (dV - work of moving targets):
// zero for midpoint with linear forces, 1/2 dv' M dv + dV/dx . dx - dV for backward Euler.
// Terms with internal variables (InternalTerms) have a stored energy, which is part of dV, and a loss. Their
// work beyond gain and loss is part of numerical_loss instead of C . dx.
// The rims of pressures on open patches and the wind are part of C; their work is reported apart from damping.
#pragma once
#include <vector>

#include "dynamics/energy_bound.h"
#include "dynamics/integrator.h"
#include "dynamics/step_report.h"

namespace aspic {

class Ledger {
 public:
  // Evaluates the elastic energies at the start of the first step. Later steps reuse those at the end of the previous
  // step.
  void begin(const Model& model, std::span<const double> q);
  // Adds the work terms of the step from tools.start to `end` to the report, and writes the energies at `end`. Requires
  // that moving targets are at the end of the step. The returned energies are meaningful only for backward Euler.
  BoundedEnergies add(const StepTools& tools, const Integrator& integrator, const State& end, const StepForces& forces,
                      StepReport& report);

  // Returns r of the last step; empty without one since begin().
  std::span<const double> residual() const { return residual_; }

 private:
  struct Works;
  Works works_of(const StepTools& tools, const State& end, const StepForces& forces);
  double write_energies(const StepTools& tools, const State& end, StepReport& report);
  double target_work(const StepTools& tools, int order, const State& end, double& loads_before, StepReport& report);
  // `known`: energies of all terms at q, elastic terms first; may be empty.
  std::span<const double> elastic_energies(const Model& model, std::span<const double> q, std::span<const double> known,
                                           Work& work);
  // Replaces V_t + T_t + W by E at the start of the minimization divided by h^2.
  void allow_moved_pins(const StepTools& tools, const State& end, BoundedEnergies& bounded, Work& work);
  // Writes the residual of the part of the model that is farthest from its threshold, and its worst vertex.
  void note_residual(const StepTools& tools, const StepForces& forces, StepReport& report);
  void note_worst_vertex(const StepTools& tools, int part, StepReport& report) const;
  // Returns the energies of the internal variables in the step.
  static InternalEnergies internal_energies(const StepTools& tools, const State& end);
  void add_resultants(const StepTools& tools, const State& end, const StepForces& forces, Resultants& sums);

  std::vector<ActiveTerm> at_start_;  // the loads at the start of the step
  std::vector<double> Ma_, momentum_, residual_;
  std::vector<double> squares_;           // squared residual of each part
  std::vector<double> load_;              // gradient of one load; zero between uses
  std::vector<double> moved_;             // q_s of energy_bound.h, then u - v_t
  std::vector<double> early_, late_;      // energy that the motion of its target adds to each load
  std::vector<double> last_q_, elastic_;  // positions and values of the last elastic energies, one per body
};

// Returns 1/2 qdot' M qdot [J]; `momentum` receives M qdot.
double kinetic_energy(const Model& model, std::span<const double> qdot, std::span<double> momentum);

}  // namespace aspic
