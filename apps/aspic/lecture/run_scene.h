// Runs a scene to its end and collects its step reports.
#pragma once
#include <functional>
#include <limits>
#include <vector>

#include "aspic/lecture/open_step.h"
#include "dynamics/step_report.h"

namespace aspic::cli::lecture {

inline constexpr double kEpsilon = std::numeric_limits<double>::epsilon();  // for bounds of round-off

struct Run {
  std::vector<StepReport> reports;
  int unconverged = 0, iterations = 0;
  double largest_energy = 0;        // kinetic + potential [J]; +inf if it is not finite in a step
  double largest_ledger_error = 0;  // relative to the largest energy flow of the step

  bool exploded(double limit) const { return !(largest_energy <= limit); }
};

using AfterStep = std::function<void(const StepReport&)>;

// Simulates `steps` steps; stops after an undefined one.
Run run(Simulation& simulation, int steps, const AfterStep& after = {}, const IterationObserver& observe = {});

// Returns the scene in motion, after a few steps.
Scene in_motion(Scene scene, int steps = 5);

}  // namespace aspic::cli::lecture
