// Where the energy of a step went. With dx = q_new - q_old, dv = qdot_new - qdot_old and the forces of the step,
//   r = M dv / h + dV/dx + dD/dx,
// r acts on pinned vertices as the reaction of the pins and on free ones as what the solve left over, and
//   dT + dV = reaction . dx + (work of moving targets) - dD/dx . dx - numerical_loss + residual . dx
// holds exactly, where the integrator itself loses
//   numerical_loss = s/2 dv' M dv + dV/dx . dx - (V_new - V_old),
// s = +1 for a scheme that moves with the new velocity, -1 with the old one, and 0 in statics.
#pragma once
#include <vector>

#include "dynamics/integrator.h"
#include "dynamics/step_report.h"

namespace aspic {

class Ledger {
 public:
  // Before the terms are told of the step.
  void open(const StepTools& tools, const State& state);
  // After they are told, before the step is taken: moving targets have moved.
  void targets_moved(const StepTools& tools, const State& state);
  // After the step. Fills the energies of the report.
  void close(const StepTools& tools, const Integrator& integrator, double h, const State& state, StepReport& report);

 private:
  void note_worst_vertex(const Pins& pins, StepReport& report) const;

  State before_;
  double kinetic_ = 0, potential_ = 0, target_work_ = 0;  // [J]
  std::vector<double> gradient_, damping_, dv_, Mdv_, at_, momentum_, residual_;
};

// 1/2 qdot' M qdot [J]; `momentum` receives M qdot.
double kinetic_energy(const MassMatrix& mass, std::span<const double> qdot, std::span<double> momentum);

}  // namespace aspic
