// bench_characters: converged steps of bodies with real shapes. They are 1 m high, held at their feet (the lowest 8 %),
// and start moving sideways with 2 m/s at the top, under gravity. bench_characters --help lists the options.

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/formatted.h"
#include "base/parallel.h"
#include "bench/machine.h"
#include "bench/program.h"
#include "bench/results.h"
#include "bench/shapes.h"
#include "bench/step_counts.h"
#include "bench/stopwatch.h"
#include "dynamics/model_builder.h"
#include "dynamics/simulation.h"
#include "math/vectors.h"

namespace aspic::bench {
namespace {

struct Arguments {
  std::vector<std::string> shapes, details = {"3k", "10k"};
  std::vector<double> young = {1e5, 1e7};  // [Pa]
  std::vector<double> rates = {60};        // steps per second
  std::vector<int> threads = {thread_count()};
  std::string linear = "auto";
  double poisson = 0.45, tolerance = 1e-4;
  int steps = 20;
  bool list = false, quiet = false;
  std::string folder = "build/shapes", csv;
};

void declare(CLI::App& app, Arguments& arguments) {
  app.add_option("shape", arguments.shapes, "Names from --list; all by default");
  app.add_option("--detail", arguments.details, "Approximate number of vertices: 3k, 10k, 30k, 100k")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--young", arguments.young, "Young's moduli [Pa]")
      ->delimiter(',')
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--poisson", arguments.poisson)->capture_default_str();
  app.add_option("--rate", arguments.rates, "Steps per second of simulated time")
      ->delimiter(',')
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--threads", arguments.threads, "Numbers of threads, separated by commas")
      ->delimiter(',')
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--linear", arguments.linear, "Linear solver")->capture_default_str();
  app.add_option("--tolerance", arguments.tolerance, "Tolerance, relative to the first gradient of each step")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--steps", arguments.steps)->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--shapes", arguments.folder, "Folder of the surfaces and the generated meshes")
      ->capture_default_str();
  app.add_option("--csv", arguments.csv, "CSV file to write the results to");
  app.add_flag("--list", arguments.list, "List the shapes and their sources");
  app.add_flag("--quiet", arguments.quiet, "Omit the description of the machine");
}

struct Case {
  std::string shape, detail;
  double young = 0, rate = 0;
  int threads = 1;
};

Simulation make_simulation(const Arguments& arguments, const TetMesh& mesh, const Case& c) {
  constexpr double kFeet = 0.08, kPush = 2;  // [m], [1/s]
  State start = at_rest(mesh);
  std::vector<int> feet;
  for (int i = 0; i < mesh.vertex_count(); ++i) {
    const double height = mesh.rest[i][1];
    if (height <= kFeet) {
      feet.push_back(i);
    } else {
      start.qdot[3 * i] = kPush * height;
    }
  }
  SimulationOptions options;
  options.h = 1 / c.rate;
  options.solver.linear = arguments.linear;
  options.solver.minimize.criterion = Criterion::first_gradient;
  options.solver.minimize.tolerance = arguments.tolerance;
  Model model = ModelBuilder(mesh)
                    .material("neo_hookean_log", {.young = c.young, .poisson = arguments.poisson})
                    .density(1000)
                    .gravity({0, -9.81, 0})
                    .pin("feet", std::move(feet))
                    .build();
  return Simulation(std::move(model), std::move(start), options);
}

struct Measured {
  std::vector<double> wall, processor;  // time of each step [s]
  StepCounts counts;
  int unconverged = 0;
  double set_up = 0;  // CPU time until the end of the first step [s]
};

// Excludes the first step, which also prepares data for all steps.
Measured take_steps(Simulation& simulation, int steps, Stopwatch& stopwatch) {
  Measured m;
  simulation.step();
  m.set_up = stopwatch.lap().processor;
  for (int i = 0; i < steps; ++i) {
    const StepReport report = simulation.step();
    const Seconds seconds = stopwatch.lap();
    m.wall.push_back(seconds.wall);
    m.processor.push_back(seconds.processor);
    add_counts(report, m.counts);
    m.unconverged += !is_success(report.status);
  }
  return m;
}

void print_head() {
  std::printf("%-10s %7s %8s %8s %6s %4s | %8s %8s %8s %8s | %6s %7s %6s | %6s\n", "shape", "threads", "vertices",
              "tets", "E [Pa]", "Hz", "ms/step", "min", "max", "cpu", "Newton", "linear", "cycles", "x real");
}

void print(const Case& c, const TetMesh& mesh, const Measured& m) {
  const double steps = static_cast<double>(m.wall.size()), wall = median(m.wall);
  std::printf("%-10s %7d %8d %8d %6.0e %4.0f | %8.2f %8.2f %8.2f %8.2f | %6.1f %7.1f %6.1f | %6.2f", c.shape.c_str(),
              c.threads, mesh.vertex_count(), mesh.tet_count(), c.young, c.rate, 1e3 * wall,
              1e3 * *std::min_element(m.wall.begin(), m.wall.end()),
              1e3 * *std::max_element(m.wall.begin(), m.wall.end()), 1e3 * median(m.processor),
              m.counts.iterations / steps, m.counts.linear_iterations / steps, m.counts.cycles / steps,
              1 / (c.rate * wall));
  if (m.unconverged > 0) std::printf("  %d steps did not converge", m.unconverged);
  std::printf("\n");
  std::fflush(stdout);
}

void record(Results& results, const Case& c, const TetMesh& mesh, const Measured& m) {
  const std::string what = formatted("%s %s E=%.0e %.0f Hz", c.shape.c_str(), c.detail.c_str(), c.young, c.rate);
  const double steps = static_cast<double>(m.wall.size());
  results.begin(what, c.threads);
  results.add("vertices", mesh.vertex_count(), "1");
  results.add("step, median", 1e3 * median(m.wall), "ms");
  results.add("step, fastest", 1e3 * *std::min_element(m.wall.begin(), m.wall.end()), "ms");
  results.add("step, slowest", 1e3 * *std::max_element(m.wall.begin(), m.wall.end()), "ms");
  results.add("step, median", 1e3 * median(m.processor), "ms of processor");
  results.add("set-up and first step", m.set_up, "s of processor");
  for (const NamedCount& named : kCounts) {
    results.add(std::string(named.name), m.counts.*named.count / steps, "per step");
  }
}

// Runs every stiffness, rate and number of threads on one mesh. Returns whether all steps converged.
bool measure(const Arguments& arguments, Case c, const TetMesh& mesh, Results& results) {
  bool converged = true;
  for (const double young : arguments.young)
    for (const double rate : arguments.rates)
      for (const int threads : arguments.threads) {
        c.young = young, c.rate = rate, c.threads = threads;
        set_thread_count(threads);
        Stopwatch stopwatch;
        Simulation simulation = make_simulation(arguments, mesh, c);
        const Measured m = take_steps(simulation, arguments.steps, stopwatch);
        print(c, mesh, m);
        record(results, c, mesh, m);
        converged &= m.unconverged == 0;
      }
  return converged;
}

bool measure_shape(const Arguments& arguments, const Shape& shape, Results& results) {
  if (!is_available(shape, arguments.folder)) {
    std::printf("%-10s omitted: no %s in %s; ./run bench characters fetches it (%s)\n", shape.name.c_str(),
                shape.file.c_str(), arguments.folder.c_str(), shape.source.c_str());
    return true;
  }
  bool converged = true;
  for (const Detail& detail : shape.details) {
    if (std::find(arguments.details.begin(), arguments.details.end(), detail.name) == arguments.details.end()) continue;
    try {
      const TetMesh mesh = standing_mesh(shape, detail, arguments.folder);
      converged &= measure(arguments, {.shape = shape.name, .detail = detail.name}, mesh, results);
    } catch (const InvalidInput& error) {
      std::printf("%-10s omitted: %s\n", shape.name.c_str(), error.what());
    }
  }
  return converged;
}

int run(const Arguments& arguments) {
  if (arguments.list) {
    for (const Shape& shape : shapes()) std::printf("%-10s %s\n", shape.name.c_str(), shape.source.c_str());
    return 0;
  }
  if (!arguments.quiet) print_facts(machine_facts());
  std::printf(
      "\ncharacters: 1 m high, nu = %g, each step to %g of its first gradient; Newton and linear iterations per "
      "step; x real: simulated by wall time\n",
      arguments.poisson, arguments.tolerance);
  print_head();
  std::vector<Shape> chosen;
  for (const std::string& name : arguments.shapes) chosen.push_back(shape_named(name));
  if (chosen.empty()) chosen = shapes();
  Results results("characters");
  bool converged = true;
  for (const Shape& shape : chosen) converged &= measure_shape(arguments, shape, results);
  results.write(arguments.csv);
  return converged ? 0 : 1;
}

}  // namespace
}  // namespace aspic::bench

int main(int argc, char** argv) {
  CLI::App app("Measures converged steps of bodies with real shapes.", "bench_characters");
  aspic::bench::Arguments arguments;
  aspic::bench::declare(app, arguments);
  return aspic::bench::run_program(app, argc, argv, [&] { return aspic::bench::run(arguments); });
}
