// A scene run to an end, and what its steps reported.
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
  double largest_energy = 0;        // kinetic + potential [J]; +inf when a step has none that is finite
  double largest_ledger_error = 0;  // relative to the largest energy that moves in the step

  bool exploded(double limit) const { return !(largest_energy <= limit); }
};

using AfterStep = std::function<void(const StepReport&)>;

// Takes `steps` steps; stops after one that is undefined, as nothing moves from there.
Run run(Simulation& simulation, int steps, const AfterStep& after = {}, const IterationObserver& observe = {});

// The scene in the middle of its motion, after a few steps.
Scene in_motion(Scene scene, int steps = 5);

}  // namespace aspic::cli::lecture
