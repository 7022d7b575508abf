// bench_beam: the beam by Aspic and, for small sizes, by the naive program. Prints one line per run, with setup, and
// checks the displacement of the indenter. bench_beam --help lists the options.

#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "bench/beam_run.h"
#include "bench/machine.h"
#include "bench/program.h"
#include "bench/results.h"
#include "bench/step_counts.h"

namespace aspic::bench {
namespace {

constexpr int kLargestNaive = 7;  // n = 14 takes the naive program minutes

struct Arguments {
  std::vector<int> sizes = {7};
  std::vector<int> threads = {1};
  std::vector<std::string> linear = {"auto"};
  double tolerance = 1e-6;
  int runs = 1;
  int largest_naive = kLargestNaive;
  bool bent = false, quiet = false;
  std::string csv;
};

void declare(CLI::App& app, Arguments& arguments) {
  const CLI::Range sizes(1, 64);
  app.add_option("n", arguments.sizes, "Cells through the thickness; 4n along the beam")
      ->check(sizes)
      ->capture_default_str();
  app.add_flag("--bent", arguments.bent, "Use the beam of 1e5 Pa with 30 steps of 1/30 s, whose tip falls 5 m");
  app.add_option("--threads", arguments.threads, "Numbers of threads, separated by commas")
      ->delimiter(',')
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--linear", arguments.linear, "Linear solvers, separated by commas")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--tolerance", arguments.tolerance, "Tolerance, relative to the first gradient of each step")
      ->check(CLI::PositiveNumber);
  app.add_option("--runs", arguments.runs, "Number of runs; the fastest is reported")->check(CLI::PositiveNumber);
  app.add_option("--naive", arguments.largest_naive, "Largest n for the naive program; 0: none");
  app.add_option("--csv", arguments.csv, "CSV file to write the results to");
  app.add_flag("--quiet", arguments.quiet, "Omit the description of the machine");
}

// Reference: every step solved to 1e-10 of its first gradient (--tolerance 1e-10 --linear cholesky).
struct Known {
  bool bent;
  int n;
  double displacement;  // displacement of the indenter [m]
};
constexpr std::array<Known, 5> kKnown = {{{false, 7, -0.0539775432},
                                          {false, 14, -0.0539697485},
                                          {false, 28, -0.0539687224},
                                          {true, 7, -5.0768673754},
                                          {true, 14, -5.1014744083}}};

std::optional<double> known_displacement(const Arguments& arguments, int n) {
  for (const Known& known : kKnown)
    if (known.bent == arguments.bent && known.n == n) return known.displacement;
  return {};
}

// The residual may change the indenter's displacement by the same relative amount.
double allowed_error(const Arguments& arguments, double displacement) {
  return std::max(arguments.tolerance * std::abs(displacement), 1e-10);
}

BeamProblem make_problem(const Arguments& arguments, int n) {
  BeamProblem problem = arguments.bent ? bent_beam(n) : falling_beam(n);
  problem.tolerance = arguments.tolerance;
  return problem;
}

void print_head() {
  std::printf("%-8s %-12s %7s %3s %8s %8s %8s %8s %8s %8s %7s %8s %7s  %-14s %s\n", "program", "solver", "threads", "n",
              "vertices", "tets", "set-up", "steps", "cpu [s]", "wall [s]", "Newton", "linear", "MB", "tip y [m]",
              "known");
}

struct Line {
  std::string program, solver;
  int threads = 1, n = 0;
};

bool print(const Arguments& arguments, const Line& line, const BeamResult& result, double megabytes) {
  const int vertices = (4 * line.n + 1) * (line.n + 1) * (line.n + 1), tets = 24 * line.n * line.n * line.n;
  const auto known = known_displacement(arguments, line.n);
  const bool right =
      result.converged && (!known || std::abs(result.displacement - *known) <= allowed_error(arguments, *known));
  std::printf("%-8s %-12s %7d %3d %8d %8d %8.3f %8.3f %8.3f %8.3f %7d %8d %7.0f  %-14.10f %s\n", line.program.c_str(),
              line.solver.c_str(), line.threads, line.n, vertices, tets, result.set_up.processor,
              result.steps.processor, result.total().processor, result.total().wall, result.iterations,
              result.linear_iterations, megabytes, result.displacement,
              !result.converged ? "NOT CONVERGED"
              : !known          ? "-"
              : right           ? "yes"
                                : "NO");
  std::fflush(stdout);
  return right;
}

void record(Results& results, const Arguments& arguments, const Line& line, const BeamResult& result) {
  results.begin(line.program + (arguments.bent ? " bent" : "") + " n=" + std::to_string(line.n) +
                    (line.solver == "auto" || line.solver == "-" ? "" : " " + line.solver),
                line.threads);
  results.add("set-up", result.set_up.processor, "s of processor");
  results.add("steps", result.steps.processor, "s of processor");
  results.add("whole run", result.total().processor, "s of processor");
  results.add("whole run", result.total().wall, "s");
}

void record_work(Results& results, const AspicRun& run) {
  StepCounts counts;
  for (const StepReport& report : run.reports) add_counts(report, counts);
  for (const NamedCount& named : kCounts) results.add(std::string(named.name), counts.*named.count, "1");
  results.add("peak memory", 1e-6 * run.peak_memory, "MB");
}

template <class Run>
auto fastest(int runs, const Run& run) {
  auto best = run();
  for (int i = 1; i < runs; ++i) {
    auto next = run();
    if (next.total().processor < best.total().processor) best = std::move(next);
  }
  return best;
}

// One size: every solver with every number of threads, then the naive program.
bool compare(const Arguments& arguments, int n, Results& results) {
  const BeamProblem problem = make_problem(arguments, n);
  bool right = true;
  double one_thread = 0;
  for (const std::string& linear : arguments.linear) {
    double one_thread_wall = 0;
    for (const int threads : arguments.threads) {
      set_thread_count(threads);
      const AspicRun run = fastest(arguments.runs, [&] { return run_aspic(problem, linear); });
      const Line line{"aspic", linear, threads, n};
      right &= print(arguments, line, run, run.peak_memory / 1e6);
      record(results, arguments, line, run);
      record_work(results, run);
      if (threads == 1) one_thread_wall = run.total().wall;
      if (threads == 1 && one_thread == 0) one_thread = run.total().processor;
      if (threads != 1 && one_thread_wall > 0) {
        std::printf("  %d threads are %.2f times faster than one\n", threads, one_thread_wall / run.total().wall);
      }
    }
  }
  if (n > arguments.largest_naive) return right;
  const BeamResult naive = run_naive(problem);
  const Line line{"naive", "-", 1, n};
  right &= print(arguments, line, naive, 0);
  record(results, arguments, line, naive);
  if (one_thread > 0) {
    std::printf("  aspic is %.1f times faster in CPU time\n", naive.total().processor / one_thread);
  }
  return right;
}

int run(const Arguments& arguments) {
  if (!arguments.quiet) print_facts(machine_facts());
  const BeamProblem problem = make_problem(arguments, 7);
  std::printf("\nbeam: %g Pa, %d steps of %.4g s, each to %g of its first gradient; setup and steps in s of CPU time\n",
              problem.young, problem.steps, problem.time_step, problem.tolerance);
  print_head();
  Results results("beam");
  bool right = true;
  for (const int n : arguments.sizes) right &= compare(arguments, n, results);
  results.write(arguments.csv);
  return right ? 0 : 1;
}

}  // namespace
}  // namespace aspic::bench

int main(int argc, char** argv) {
  CLI::App app("Simulates the benchmark beam, including setup.", "bench_beam");
  aspic::bench::Arguments arguments;
  aspic::bench::declare(app, arguments);
  return aspic::bench::run_program(app, argc, argv, [&] { return aspic::bench::run(arguments); });
}
