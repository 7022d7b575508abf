#include "aspic/lecture/run_scene.h"

#include <algorithm>
#include <cmath>

namespace aspic::cli::lecture {

Run run(Simulation& simulation, int steps, const AfterStep& after, const IterationObserver& observe) {
  Run result;
  for (int i = 0; i < steps; ++i) {
    const StepReport report = simulation.step(observe);
    result.reports.push_back(report);
    result.unconverged += !is_success(report.status);
    result.iterations += report.iterations;
    const double energy = report.kinetic + report.potential_total;
    if (report.status == Status::undefined || !std::isfinite(energy)) {
      result.largest_energy = INFINITY;
      break;
    }
    result.largest_energy = std::max(result.largest_energy, energy);
    const double size = std::max({std::abs(report.kinetic), std::abs(report.potential_total), std::abs(report.pin_work),
                                  std::abs(report.numerical_loss)});
    result.largest_ledger_error = std::max(result.largest_ledger_error, std::abs(report.ledger_error) / size);
    if (after) after(report);
  }
  return result;
}

Scene in_motion(Scene scene, int steps) {
  for (int i = 0; i < steps; ++i) scene.simulation.step();
  return scene;
}

}  // namespace aspic::cli::lecture
