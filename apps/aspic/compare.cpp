// `aspic compare`: compares several methods on the same step of a scene.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "aspic/commands.h"
#include "aspic/interrupt.h"
#include "aspic/method_text.h"
#include "aspic/plot.h"
#include "aspic/report_page.h"
#include "base/error.h"
#include "base/parallel.h"
#include "dynamics/method_comparison.h"
#include "io/atomic_file.h"
#include "io/csv.h"
#include "mesh/elements.h"
#include "scene/scene.h"

namespace aspic::cli {
namespace {

namespace fs = std::filesystem;

std::string reached(const MethodResult& result) {
  const Status status = result.report.status;
  if (result.same_minimizer) return "same minimizer";
  if (is_success(status)) return "another point";
  const bool is_late = status == Status::budget || status == Status::interrupted;
  return is_late ? "time limit" : std::string(to_string(status));
}

std::string distance(const MethodResult& result) {
  return std::isnan(result.distance) ? "-" : fmt::format("{:.1e}", result.distance);
}

void write_methods(const fs::path& path, const Comparison& comparison) {
  CsvFile file = CsvFile::create(
      path, {"method", "status", "same_minimizer", "iterations", "gradients", "hessians", "factorizations",
             "linear_iterations", "trials", "seconds", "objective", "excess", "gradient_norm", "distance"});
  for (const MethodResult& result : comparison.results) {
    const StepReport& report = result.report;
    CsvRow row;
    row.add(result.method).add(to_string(report.status)).add(result.same_minimizer ? 1 : 0);
    row.add(report.iterations).add(report.gradients).add(report.hessians).add(report.factorizations);
    row.add(report.linear_iterations).add(report.trials).add(result.seconds).add(report.objective);
    file.append(row.add(result.excess).add(report.objective_gradient).add(result.distance));
  }
  file.close();
}

void write_work(const fs::path& path, const Comparison& comparison) {
  CsvFile file = CsvFile::create(
      path, {"method", "iteration", "gradients", "hessians", "seconds", "value", "excess", "gradient_norm"});
  for (const MethodResult& result : comparison.results)
    for (const WorkPoint& point : result.work) {
      CsvRow row;
      row.add(result.method).add(point.iteration).add(point.gradients).add(point.hessians).add(point.seconds);
      file.append(row.add(point.value).add(point.value - comparison.reference.objective).add(point.gradient_norm));
    }
  file.close();
}

nlohmann::ordered_json json_of(const MethodResult& result) {
  return {{"method", result.method},
          {"description", result.description},
          {"status", to_string(result.report.status)},
          {"same_minimizer", result.same_minimizer},
          {"iterations", result.report.iterations},
          {"gradients", result.report.gradients},
          {"hessians", result.report.hessians},
          {"factorizations", result.report.factorizations},
          {"linear_iterations", result.report.linear_iterations},
          {"trials", result.report.trials},
          {"seconds", result.seconds},
          {"objective", result.report.objective},
          {"excess", result.excess},
          {"gradient_norm", result.report.objective_gradient},
          {"distance", result.distance}};
}

void write_json(const fs::path& path, const std::string& scene, const Comparison& comparison) {
  nlohmann::ordered_json results = nlohmann::json::array();
  for (const MethodResult& result : comparison.results) results.push_back(json_of(result));
  const nlohmann::ordered_json json = {{"scene", scene},
                                       {"step", comparison.step},
                                       {"reference",
                                        {{"objective", comparison.reference.objective},
                                         {"gradient_norm", comparison.reference.objective_gradient},
                                         {"iterations", comparison.reference.iterations}}},
                                       {"methods", results}};
  write_file(path, json.dump(2) + "\n");
}

enum class Work { iterations, seconds };

// Distance of E from its minimum, down to the round-off floor of E.
Chart precision_chart(const Comparison& comparison, Work work) {
  const bool is_time = work == Work::seconds;
  Chart chart;
  chart.title = is_time ? "Accuracy over time" : "Accuracy over iterations";
  chart.x = {.label = is_time ? "time [s]" : "iteration (from 1)", .scale = AxisScale::logarithmic};
  chart.y = {.label = "E - E* [relative to the start]", .scale = AxisScale::logarithmic};
  const double end = comparison.reference.objective;
  for (const MethodResult& result : comparison.results) {
    if (result.work.empty()) continue;
    const double start = result.work.front().value - end;
    const double noise = std::numeric_limits<double>::epsilon() * std::abs(end);
    Series series{.label = result.method, .style = SeriesStyle::line_and_points};
    for (const WorkPoint& point : result.work) {
      if (point.iteration == 0) continue;  // zero has no place on a logarithmic axis
      series.x.push_back(is_time ? point.seconds : point.iteration);
      series.y.push_back(std::max(point.value - end, noise) / start);
    }
    if (series.x.size() > 60) series.style = SeriesStyle::line;
    chart.series.push_back(std::move(series));
  }
  return chart;
}

std::vector<Cell> row_of(const MethodResult& result) {
  const Verdict verdict = result.same_minimizer ? Verdict::pass : Verdict::fail;
  const StepReport& report = result.report;
  return {{result.method},
          {reached(result), verdict},
          {std::to_string(report.iterations)},
          {std::to_string(report.gradients)},
          {std::to_string(report.hessians)},
          {fmt::format("{:.3g}", 1e3 * result.seconds)},
          {fmt::format("{:.2e}", result.excess)},
          {fmt::format("{:.2e}", report.objective_gradient)},
          {distance(result)}};
}

void write_page(const fs::path& folder, const std::string& scene, const Comparison& comparison, bool has_pictures) {
  ReportPage page("Methods compared", fmt::format("{}, step {}", scene, comparison.step));
  page.paragraph(
      "Every method solves the same time step from the same state. The reference is Newton's method at the limit of "
      "double precision, E* its objective. The excess of E is E - E*, relative to the start.");
  std::vector<std::vector<Cell>> rows;
  for (const MethodResult& result : comparison.results) rows.push_back(row_of(result));
  page.table(
      {"method", "reached", "iterations", "gradients", "Hessians", "time [ms]", "excess of E", "|g|", "distance [m]"},
      rows);
  if (has_pictures)
    page.figures({{folder / "time.svg", "Distance of E from its minimum over time."},
                  {folder / "iterations.svg", "The same over iterations."}});
  page.heading("Settings");
  for (const MethodResult& result : comparison.results) page.paragraph(result.method + ": " + result.description);
  page.write(folder / "index.html");
}

// Writes methods.csv, work.csv, comparison.json, iterations.svg, time.svg, index.html to an existing folder. Without
// gnuplot it omits pictures and returns the reason, else an empty text. Throws InvalidInput if writing fails.
std::string write_comparison(const fs::path& folder, const std::string& scene, const Comparison& comparison) {
  write_methods(folder / "methods.csv", comparison);
  write_work(folder / "work.csv", comparison);
  write_json(folder / "comparison.json", scene, comparison);
  std::string missing;
  try {
    draw(folder / "time.svg", precision_chart(comparison, Work::seconds));
    draw(folder / "iterations.svg", precision_chart(comparison, Work::iterations));
  } catch (const InvalidInput& reason) {
    missing = reason.what();
  }
  write_page(folder, scene, comparison, missing.empty());
  return missing;
}

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
    fmt::print("{:<{}}  {:<16} {:>10} {:>10} {:>8} {:>10.3g} {:>11.1e} {:>10}\n", result.method, width, reached(result),
               report.iterations, report.gradients, report.hessians, 1e3 * result.seconds, result.excess,
               distance(result));
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
  std::vector<ComparedMethod> methods;
  for (const std::string& method : arguments.methods)
    methods.push_back({method, method_named(method, scene.simulation.options().solver)});
  const fs::path folder = arguments.out.empty() ? fs::path("out") / ("compare_" + scene.name) : arguments.out;
  create(folder);
  const Model& model = scene.simulation.model();
  fmt::print("{}: {}; step {} by each method, {} threads\n", scene.name, size_text(model.mesh), arguments.step,
             thread_count());
  std::fflush(stdout);
  const auto begun = [&](const std::string& method) {
    fmt::print(stderr, "{} ... (at most {:.3g} s)\n", method, arguments.max_seconds);
  };
  catch_interrupts();
  const Comparison comparison =
      compare_methods(scene.simulation, {.methods = methods,
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
  fmt::print("excess of E: E - E*, relative to the start\n");

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
  command->add_option("--max-seconds", arguments->max_seconds, "Time limit per method [s]; 60 by default")
      ->check(CLI::Range(1e-3, 1e9));
  command->add_option("--threads", arguments->threads, "Threads; all cores by default")->check(CLI::Range(1, 1024));
  command->add_option("--out", arguments->out, "Folder for tables and pictures; out/compare_NAME by default");
  command->callback([arguments, &action] { action = [arguments] { return compare(*arguments); }; });
}

}  // namespace aspic::cli
