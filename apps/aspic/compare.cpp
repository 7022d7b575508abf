// `aspic compare`: compares several methods on the same step of a scene.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "aspic/commands.h"
#include "aspic/comparison.h"
#include "aspic/comparison_files.h"
#include "aspic/interrupt.h"
#include "base/error.h"
#include "base/parallel.h"
#include "scene/scene.h"

namespace aspic::cli {
namespace {

namespace fs = std::filesystem;

struct CompareArguments {
  fs::path input, out;
  std::vector<std::string> methods, overrides;
  int step = 1, threads = 0;
  double max_seconds = 60;
};

void print_table(const Comparison& comparison) {
  size_t width = 6;
  for (const MethodResult& result : comparison.results) width = std::max(width, result.method.size());
  fmt::print("{:<{}}  {:<16} {:>10} {:>10} {:>8} {:>10} {:>11} {:>10}\n", "method", width, "reached", "iterations",
             "gradients", "Hessians", "time [ms]", "excess of E", "dist. [m]");
  for (const MethodResult& result : comparison.results) {
    const StepReport& report = result.report;
    const std::string reached = result.same_minimizer       ? "same minimizer"
                                : is_success(report.status) ? "another point"
                                                            : std::string(to_string(report.status));
    fmt::print("{:<{}}  {:<16} {:>10} {:>10} {:>8} {:>10.3g} {:>11.1e} {:>10.1e}\n", result.method, width, reached,
               report.iterations, report.gradients, report.hessians, 1e3 * result.seconds, result.excess,
               result.distance);
  }
}

// Called before the work, which may take long.
void create(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InvalidInput(folder.string() + ": cannot be created: " + error.message());
}

int compare(const CompareArguments& arguments) {
  if (arguments.threads > 0) set_thread_count(arguments.threads);
  Scene scene = load_scene(arguments.input, {.overrides = arguments.overrides, .mesher = {}});
  const fs::path folder = arguments.out.empty() ? fs::path("out") / ("compare_" + scene.name) : arguments.out;
  create(folder);
  const Model& model = scene.simulation.model();
  fmt::print("{}: {} vertices, {} tets; step {} by each method, {} threads\n", scene.name, model.mesh.vertex_count(),
             model.mesh.tet_count(), arguments.step, thread_count());
  std::fflush(stdout);
  const auto begun = [](const std::string& method) { fmt::print(stderr, "{} ...\n", method); };
  catch_interrupts();
  const Comparison comparison =
      compare_methods(scene.simulation, {.methods = arguments.methods,
                                         .step = arguments.step,
                                         .max_seconds = arguments.max_seconds,
                                         .begun = begun,
                                         .stop = StopToken([] { return interrupt_signal() != 0; })});
  if (!comparison.has_reference) {
    fmt::print(stderr, "interrupted before the reference was computed: nothing was written\n");
    return exit_signal + interrupt_signal();
  }
  fmt::print("E* = {:.10g} by Newton's method at round-off, {} iterations, |g| = {:.1e}\n\n",
             comparison.reference.objective, comparison.reference.iterations, comparison.reference.objective_gradient);
  print_table(comparison);

  const std::string missing = write_comparison(folder, scene.name, comparison);
  if (!missing.empty()) fmt::print(stderr, "note: no pictures: {}\n", missing);
  fmt::print("\nresults    {}\n", (folder / "index.html").string());
  if (comparison.interrupted) {
    fmt::print(stderr, "interrupted: {} of {} methods are in the tables\n", comparison.results.size(),
               arguments.methods.size());
    return exit_signal + interrupt_signal();
  }
  const auto agrees = [](const MethodResult& result) { return result.same_minimizer; };
  return std::all_of(comparison.results.begin(), comparison.results.end(), agrees) ? exit_done : exit_unconverged;
}

}  // namespace

void add_compare(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<CompareArguments>();
  CLI::App* command = app.add_subcommand("compare", "Solves one step of a scene by several methods");
  command->footer(R"(
A method is NAME[:OPTION...], where an option is a definiteness, a preconditioner or a linear solver:
newton, newton:clamped, newton:clamped:cholesky, gradient_descent, ... (docs/methods.md describes them).

Examples:
  aspic compare scenes/bunny.toml --methods newton,gradient_descent
  aspic compare beam.toml --methods newton:exact,newton:clamped --step 20 --set solver.tolerance=1e-8

Exit codes: 0 every method reached the same minimizer, 2 bad input, 3 some did not,
130 interrupted by Ctrl-C, 143 by kill: finished methods are written.)");
  command->add_option("SCENE", arguments->input, "Scene (.toml) or mesh")->required();
  command->add_option("--methods", arguments->methods, "Methods, separated by commas")->required()->delimiter(',');
  command->add_option("--step", arguments->step, "Number of the step; earlier steps use the method of the scene")
      ->check(CLI::Range(1, 1000000000));
  command->add_option("--set", arguments->overrides, "Override values: solver.tolerance=1e-8; several may follow")
      ->allow_extra_args(false);
  command->add_option("--max-seconds", arguments->max_seconds, "Time limit per method [s]")
      ->check(CLI::Range(1e-3, 1e9));
  command->add_option("--threads", arguments->threads, "Threads; all cores by default")->check(CLI::Range(1, 1024));
  command->add_option("--out", arguments->out, "Folder for tables and pictures; out/compare_NAME by default");
  command->callback([arguments, &action] { action = [arguments] { return compare(*arguments); }; });
}

}  // namespace aspic::cli
