#include "bench/beam_run.h"

#include <utility>

#include "bench/machine.h"
#include "dynamics/model_builder.h"

namespace aspic::bench {

Simulation make_beam_simulation(const BeamProblem& problem, const std::string& linear) {
  const TetMesh mesh = make_beam(problem.n);
  std::vector<int> clamped;
  for (int i = 0; i < mesh.vertex_count(); ++i)
    if (is_clamped(mesh, i)) clamped.push_back(i);
  SimulationOptions options;
  options.h = problem.time_step;
  options.solver.linear = linear;
  options.solver.minimize.criterion = Criterion::first_gradient;
  options.solver.minimize.tolerance = problem.tolerance;
  return Simulation(ModelBuilder(mesh)
                        .material("neo_hookean_log", {.young = problem.young, .poisson = kPoisson})
                        .density(kDensity)
                        .gravity({0, -9.81, 0})
                        .pin("clamp", std::move(clamped))
                        .build(),
                    options);
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
