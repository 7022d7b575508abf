// Where the energy of a step went. With dx = q_new - q_old, the effective forces G and C of the step and its effective
// acceleration a (see StepForces),
//   r = M a + G + C,
// r acts on pinned vertices as the reaction of the pins and on free ones as what the solves left over, and
//   dT + dV = reaction . dx + (work of moving targets) - C . dx - numerical_loss + residual . dx
// holds exactly, where the integrator itself loses
//   numerical_loss = (a' M dx - dT) + G . dx - (dV - work of moving targets):
// nothing for midpoint with linear forces, 1/2 dv' M dv + dV/dx . dx - dV for backward Euler.
#pragma once
#include <vector>

#include "dynamics/energy_bound.h"
#include "dynamics/integrator.h"
#include "dynamics/step_report.h"

namespace aspic {

class Ledger {
 public:
  // Evaluates the elastic energies of the state from which the next step starts: afterwards each step ends where the
  // next one starts, and evaluates only those of its end.
  void begin(const Model& model, std::span<const double> q);
  // Adds the works of a step that started in tools.start, was acted on by `forces` and ended in `end` to the report,
  // whose energies become those of `end`. Moving targets then stand where they are at the end of the step. What it
  // returns is about a step of backward Euler.
  BoundedEnergies add(const StepTools& tools, const Integrator& integrator, const State& end, const StepForces& forces,
                      StepReport& report);

 private:
  double target_work(const StepTools& tools, int order, const State& end, double& loads_before, StepReport& report);
  // `known`: those at q of all terms, the elastic ones first, or none.
  std::span<const double> elastic_energies(const Model& model, std::span<const double> q, std::span<const double> known,
                                           Work& work);
  // Puts what E was at its start, divided by h^2, in place of V_t + T_t + W.
  void allow_moved_pins(const StepTools& tools, const State& end, BoundedEnergies& bounded, Work& work);
  // The residual of the part of the model that is farthest from its threshold, and its worst vertex.
  void note_residual(const StepTools& tools, const StepForces& forces, StepReport& report);
  void note_worst_vertex(const StepTools& tools, int part, StepReport& report) const;
  void add_resultants(const StepTools& tools, const State& end, const StepForces& forces, Resultants& sums);

  std::vector<double> Ma_, momentum_, residual_;
  std::vector<double> squares_;           // of the residual, by parts
  std::vector<double> load_;              // the gradient of one load; zero between
  std::vector<double> moved_;             // the positions with which E is compared where pins move, then u - v_t
  std::vector<double> early_, late_;      // of each load: what its target's motion adds to its energy
  std::vector<double> last_q_, elastic_;  // where the elastic energies were evaluated last, and one for each body
};

// 1/2 qdot' M qdot [J]; `momentum` receives M qdot.
double kinetic_energy(const MassMatrix& mass, std::span<const double> qdot, std::span<double> momentum);

}  // namespace aspic
