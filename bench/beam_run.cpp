#include "bench/beam_run.h"

#include <utility>

#include "bench/machine.h"
#include "bench/model.h"

namespace aspic::bench {

Simulation make_beam_simulation(const BeamProblem& problem, const std::string& linear) {
  TetMesh mesh = make_beam(problem.n);
  std::vector<int> clamped;
  for (int i = 0; i < mesh.vertex_count(); ++i)
    if (is_clamped(mesh, i)) clamped.push_back(i);
  State start = at_rest(mesh);
  Model model = make_model(std::move(mesh), {.young = problem.young, .poisson = kPoisson, .density = kDensity},
                           std::move(clamped));
  SimulationOptions options;
  options.h = problem.time_step;
  options.solver.linear = linear;
  options.solver.minimize.criterion = Criterion::first_gradient;
  options.solver.minimize.tolerance = problem.tolerance;
  return {std::move(model), std::move(start), options};
}

AspicRun run_aspic(const BeamProblem& problem, const std::string& linear) {
  AspicRun run;
  forget_peak_memory();
  Stopwatch stopwatch;
  Simulation simulation = make_beam_simulation(problem, linear);
  run.set_up = stopwatch.lap();
  run.reports.reserve(problem.steps);
  for (int i = 0; i < problem.steps; ++i) {
    const StepReport& report = run.reports.emplace_back(simulation.step());
    run.iterations += report.iterations;
    run.linear_iterations += report.linear_iterations;
    run.converged &= is_success(report.status);
  }
  run.steps = stopwatch.lap();
  run.displacement = simulation.state().q[3 * tip_vertex(problem.n) + 1];  // y = 0 at rest
  run.solver = simulation.solver_description();
  run.peak_memory = peak_memory();
  return run;
}

}  // namespace aspic::bench
