// bench_adjoint: cost of a gradient relative to its forward solve, in statics (a beam that sags from rest) and in
// motion (the released beam). CPU time, minimum of several runs.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "bench/machine.h"
#include "bench/program.h"
#include "bench/stopwatch.h"
#include "dynamics/model_builder.h"
#include "fit/equilibrium.h"
#include "fit/trajectory.h"
#include "mesh/generators.h"

namespace aspic::bench {
namespace {

struct Arguments {
  std::vector<int> sizes = {4, 8};
  std::vector<std::string> linear = {"auto"};
  std::string material = "stable_neo_hookean";
  double young = 5e5, h = 1.0 / 60, tolerance = 1e-9, stiffness_damping = 0;
  int steps = 20, runs = 3, threads = 1;
};

Model make_beam(int n, const Arguments& arguments) {
  ModelBuilder builder(make_box({{0, 0, 0}}, {{4, 1, 1}}, {4 * n, n, n}), "beam");
  builder.material(arguments.material, {.young = arguments.young, .poisson = 0.4})
      .density(1000)
      .gravity({{0, -9.81, 0}})
      .pin("wall", [](const Vec3d& X) { return X[0] < 1e-9; });
  if (arguments.stiffness_damping > 0) builder.rayleigh_damping(0.1, arguments.stiffness_damping);
  return builder.build();
}

struct Cost {
  double forward = 1e300, backward = 1e300;           // CPU time [s]
  long newton = 0, factorizations = 0;                // in the forward solve; with preconditioners
  long back_factorizations = 0, back_iterations = 0;  // in the gradient; of conjugate gradients
};

void print(const char* what, int n, const std::string& linear, int vertices, const Cost& cost) {
  std::printf("%-8s %3d %-12s %8d %8ld %8ld %8ld %8ld %10.4f %10.4f %7.1f %%\n", what, n, linear.c_str(), vertices,
              cost.newton, cost.factorizations, cost.back_factorizations, cost.back_iterations, cost.forward,
              cost.backward, 100 * cost.backward / cost.forward);
  std::fflush(stdout);
}

bool bench_statics(int n, const std::string& linear, const Arguments& arguments) {
  Cost cost;
  Model first = make_beam(n, arguments);
  const std::vector<double> rest = at_rest(first.mesh).q;
  const int vertices = first.mesh.vertex_count(), tets = first.mesh.tet_count();
  Equilibrium body(std::move(first), rest,
                   {.tolerance = arguments.tolerance, .linear = linear, .adjoint = linear, .solves = 1});
  std::vector<double> thetabar(static_cast<size_t>(body.parameters_per_tet()) * tets);
  for (int run = 0; run <= arguments.runs; ++run) {  // the first run analyzes the pattern
    body.set_x(rest);
    Stopwatch stopwatch;
    const MinimizeReport report = body.solve();
    const double forward = stopwatch.lap().processor;
    SolveReport adjoint;
    const bool solved = is_success(report.status) && body.factorize();
    if (solved) adjoint = body.add_adjoint(body.x(), thetabar);
    if (!adjoint.ok) {
      std::printf("statics, n = %d: %s\n", n, body.failure().c_str());
      return false;
    }
    if (run == 0) continue;
    cost.backward = std::min(cost.backward, stopwatch.lap().processor);
    cost.forward = std::min(cost.forward, forward);
    cost.newton = report.iterations;
    cost.factorizations = report.factorizations;
    cost.back_factorizations = 1;
    cost.back_iterations = adjoint.iterations;
  }
  print("statics", n, linear, vertices, cost);
  return true;
}

bool bench_motion(int n, const std::string& linear, const Arguments& arguments) {
  Cost cost;
  Model model = make_beam(n, arguments);
  const State start = at_rest(model.mesh);
  const int vertices = model.mesh.vertex_count();
  Trajectory trajectory(std::move(model), start,
                        {.h = arguments.h,
                         .steps = arguments.steps,
                         .tolerance = arguments.tolerance,
                         .linear = linear,
                         .adjoint = linear,
                         .stored_states = arguments.steps});
  const TrajectoryObjective end = [&](int point, const State& state, std::span<double> qbar, std::span<double>) {
    if (point < arguments.steps) return 0.0;
    double value = 0;
    for (size_t i = 0; i < state.q.size(); ++i) value += state.q[i] * state.q[i] / 2;
    for (size_t i = 0; i < qbar.size(); ++i) qbar[i] += state.q[i];
    return value;
  };
  TrajectoryGradient gradient;
  for (int run = 0; run <= arguments.runs; ++run) {
    Stopwatch stopwatch;
    if (const TrajectoryReport report = trajectory.simulate(end); !report.ok) {
      std::printf("motion, n = %d: %s\n", n, report.message.c_str());
      return false;
    }
    const double forward = stopwatch.lap().processor;
    const TrajectoryReport report = trajectory.differentiate(end, gradient);
    const double both = stopwatch.lap().processor;
    if (!report.ok) {
      std::printf("motion, n = %d: %s\n", n, report.message.c_str());
      return false;
    }
    if (run == 0) continue;
    cost.backward = std::min(cost.backward, both - forward);
    cost.forward = std::min(cost.forward, forward);
    cost.newton = report.newton_iterations;
    cost.factorizations = report.factorizations;
    cost.back_factorizations = report.adjoint_factorizations;
    cost.back_iterations = report.adjoint_iterations;
  }
  print("motion", n, linear, vertices, cost);
  return true;
}

}  // namespace
}  // namespace aspic::bench

int main(int argc, char** argv) {
  using namespace aspic::bench;
  CLI::App app("Measures the cost of a gradient relative to its forward solve.");
  Arguments arguments;
  app.add_option("n", arguments.sizes, "Cells through the thickness; 4n along the beam")->capture_default_str();
  app.add_option("--linear", arguments.linear, "Linear solvers, separated by commas")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--material", arguments.material)->capture_default_str();
  app.add_option("--young", arguments.young, "Young's modulus [Pa]")->capture_default_str();
  app.add_option("--step", arguments.h, "Time step [s]")->capture_default_str();
  app.add_option("--steps", arguments.steps)->capture_default_str();
  app.add_option("--tolerance", arguments.tolerance, "Tolerance of the forward solves")->capture_default_str();
  app.add_option("--stiffness-damping", arguments.stiffness_damping, "Stiffness damping [s]")->capture_default_str();
  app.add_option("--threads", arguments.threads)->capture_default_str();
  app.add_option("--runs", arguments.runs, "Number of runs; the fastest is reported")->check(CLI::PositiveNumber);
  return run_program(app, argc, argv, [&] {
    aspic::set_thread_count(arguments.threads);
    print_facts(machine_facts());
    std::printf("%-8s %3s %-12s %8s %8s %8s %8s %8s %10s %10s %9s\n", "", "n", "solver", "vertices", "Newton",
                "factors", "back:fac", "CG", "forward [s]", "back [s]", "back");
    bool ok = true;
    for (const int n : arguments.sizes)
      for (const std::string& linear : arguments.linear)
        ok = bench_statics(n, linear, arguments) && bench_motion(n, linear, arguments) && ok;
    return ok ? 0 : 1;
  });
}
