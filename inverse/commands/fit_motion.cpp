// `aspic fit-motion`: fits material, density, damping and initial velocity of a scene to a measured motion of markers.
#include "commands/commands.h"
#include "estimate/motion_fit.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "aspic/interrupt.h"
#include "aspic/plot.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/printable.h"
#include "commands/fit_progress.h"
#include "data/motion_table.h"
#include "io/atomic_file.h"
#include "io/csv.h"
#include "model/limits.h"
#include "pipeline/motion_scene.h"

namespace aspic::cli {
namespace {

namespace fs = std::filesystem;

struct FitMotionArguments {
  fs::path scene, positions, out;
  std::vector<std::string> names, overrides;
  int threads = 0, max_iterations = 100;  // 0: all cores
  double time_limit = 0;                  // [s]; 0: none
  bool force = false, json = false;
};

fs::path created_folder(const FitMotionArguments& arguments, const std::string& scene) {
  const fs::path folder = arguments.out.empty() ? fs::path("out") / (scene + "_motion") : arguments.out;
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error))
    throw InvalidInput(folder.string() + ": is not a folder; choose another one with --out");
  if (!arguments.force && fs::is_directory(folder, error) && !fs::is_empty(folder, error))
    throw InvalidInput(folder.string() +
                       ": is not empty; choose another folder with --out, or replace its files with "
                       "--force");
  fs::create_directories(folder, error);
  if (error) throw InvalidInput(folder.string() + ": cannot be created: " + error.message());
  return folder;
}

bool is_converged(const MotionFitReport& report) { return is_success(report.status) && !report.stopped; }

std::string sigma_text(const FittedMotionValue& value) {
  return std::isfinite(value.sigma) ? fmt::format("{:.2g}", value.sigma) : "-";
}

void print_table(const MotionFitReport& report, bool has_sigma) {
  fmt::print("{:<20} {:>12} {:>12} {:>10}  unit\n", "parameter", "guess", "fitted", "sd");
  for (const FittedMotionValue& v : report.values)
    fmt::print("{:<20} {:>12.6g} {:>12.6g} {:>10}  {}{}\n", v.parameter.name, v.parameter.guess, v.value, sigma_text(v),
               v.parameter.unit, v.message.empty() ? "" : "  not determined: " + v.message);
  fmt::print("root mean square distance {:.4g} m before, {:.4g} m after\n", report.before.rms, report.after.rms);
  if (has_sigma && report.chi_squared > kTooManySquares)
    fmt::print(
        "residuals are {:.3g} times the stated sigma, and standard deviations are multiplied by this factor: the model "
        "does not explain the motion (check mesh, fitted parameters and markers)\n",
        std::sqrt(report.chi_squared));
  fmt::print("{} after {} iterations, {} simulations, {} gradients\n",
             report.stopped ? "stopped" : std::string(to_string(report.status)), report.iterations, report.simulations,
             report.gradients);
}

nlohmann::ordered_json to_json(const MotionFitReport& report, const MotionObjective& objective) {
  nlohmann::ordered_json values = nlohmann::json::array();
  for (const FittedMotionValue& v : report.values) {
    nlohmann::ordered_json value = {
        {"name", v.parameter.name}, {"unit", v.parameter.unit}, {"guess", v.parameter.guess}, {"value", v.value}};
    value["deviation"] = std::isfinite(v.sigma) ? nlohmann::ordered_json(v.sigma) : nullptr;
    value["determined"] = std::isfinite(v.sigma);
    if (!v.message.empty()) value["message"] = v.message;
    values.push_back(std::move(value));
  }
  return {{"status", report.stopped ? "stopped" : std::string(to_string(report.status))},
          {"converged", is_converged(report)},
          {"parameters", values},
          {"rms_before", report.before.rms},
          {"rms_after", report.after.rms},
          {"chi_squared", objective.data().has_sigma ? nlohmann::ordered_json(report.chi_squared) : nullptr},
          {"samples", objective.data().samples.size()},
          {"markers", objective.data().markers.size()},
          {"iterations", report.iterations},
          {"simulations", report.simulations},
          {"gradients", report.gradients}};
}

void write_residuals(const fs::path& path, const MotionTable& table, const MotionData& data,
                     const MotionFitReport& report) {
  CsvFile file = CsvFile::create(path, {"time", "marker", "x", "y", "z", "simulated_x", "simulated_y", "simulated_z"});
  for (size_t s = 0; s < data.samples.size(); ++s) {
    const MotionSample& sample = data.samples[s];
    CsvRow row;
    row.add(sample.time).add(table.markers[sample.marker]);
    for (int axis = 0; axis < 3; ++axis) row.add(sample.position[axis]);
    for (int axis = 0; axis < 3; ++axis) row.add(report.after.simulated[s][axis]);
    file.append(row);
  }
  file.close();
}

// The root mean square distance over the markers at each time.
Series distances(const std::string& label, const MotionData& data, const MotionPoint& point) {
  Series series{.label = label};
  for (size_t s = 0, end = 0; s < data.samples.size(); s = end) {
    double square = 0;
    for (end = s; end < data.samples.size() && data.samples[end].time == data.samples[s].time; ++end) {
      const Vec3d d = point.simulated[end] - data.samples[end].position;
      square += dot(d, d);
    }
    series.x.push_back(data.samples[s].time);
    series.y.push_back(std::sqrt(square / static_cast<double>(end - s)));
  }
  return series;
}

void draw_distances(const fs::path& path, const MotionData& data, const MotionFitReport& report) {
  try {
    draw(path, Chart{.title = "Distance between measured and simulated markers",
                     .x = {.label = "time [s]"},
                     .y = {.label = "root mean square distance [m]", .scale = AxisScale::logarithmic},
                     .series = {distances("before", data, report.before), distances("after", data, report.after)}});
  } catch (const InvalidInput& missing) {
    fmt::print(stderr, "note: no picture: {}\n", missing.what());
  }
}

MotionFitReport fit(const FitMotionArguments& arguments, MotionObjective& objective) {
  FitProgress progress(stderr, false);
  MotionFitReport report =
      fit_motion(objective, {.max_iterations = arguments.max_iterations, .observe = [&](const MotionFitProgress& at) {
                               progress.show(fmt::format("iteration {:>3}  distance {:.4g} m  {} simulations",
                                                         at.iteration, at.rms, at.simulations));
                             }});
  progress.finish();
  return report;
}

int exit_code(const MotionFitReport& report) {
  if (interrupt_signal()) return exit_signal + interrupt_signal();
  if (report.stopped) return exit_time_limit;
  return is_converged(report) ? exit_done : exit_unconverged;
}

void print_notes(const std::vector<std::string>& notes, const std::vector<MotionParameter>& parameters) {
  for (const std::string& note : notes) fmt::print(stderr, "note: {}\n", printable(note));
  for (const MotionParameter& parameter : parameters)
    if (!parameter.note.empty())
      fmt::print(stderr, "note: {} is 0 in the scene; the guess is {:.4g} {} ({})\n", parameter.name, parameter.guess,
                 parameter.unit, parameter.note);
}

int run(const FitMotionArguments& arguments) {
  const WallClock clock = steady_seconds;
  StopToken stop([] { return interrupt_signal() != 0; });
  if (arguments.time_limit > 0) stop = stop.with_deadline(clock, arguments.time_limit);
  if (arguments.threads > 0) set_thread_count(arguments.threads);

  const MotionTable table = read_motion_table(arguments.positions);
  MotionScene scene = load_motion_scene(arguments.scene, arguments.overrides, arguments.names);
  const MotionData data =
      attach_markers(table, scene.model.model.mesh, scene.model.start, scene.options.h, scene.notes);
  scene.options.stop = stop;
  MotionObjective objective(std::move(scene.model), data, arguments.names, scene.options);
  const fs::path folder = created_folder(arguments, scene.name);
  print_notes(scene.notes, objective.parameters().parameters());
  catch_interrupts();

  const MotionFitReport report = fit(arguments, objective);
  if (!report.before.ok) {
    fmt::print(stderr, "error: {}: the motion of the guess failed: {}\n", printable(arguments.scene.string()),
               report.message);
    return exit_code(report);
  }
  const std::string json = to_json(report, objective).dump(2) + "\n";
  write_file(folder / "fit.json", json);
  write_residuals(folder / "residuals.csv", table, objective.data(), report);
  draw_distances(folder / "fit.svg", objective.data(), report);
  write_fitted_scene({arguments.scene, folder, arguments.overrides, arguments.names, scene.body},
                     objective.parameters(), report.p);
  if (arguments.json) {
    fmt::print("{}", json);
  } else {
    print_table(report, objective.data().has_sigma);
    fmt::print("fitted scene: {}\n", printable((folder / "fitted.toml").string()));
  }
  return exit_code(report);
}

}  // namespace

void add_fit_motion(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<FitMotionArguments>();
  CLI::App* command =
      app.add_subcommand("fit-motion", "Fits material, damping and initial velocity to a measured motion");
  command->footer(R"(
Examples:
  aspic fit-motion beam.toml positions.csv --fit young,mass_damping,velocity
  aspic fit-motion beam.toml positions.csv --fit young -o soft --set material.poisson=0.45 --time-limit 600
  aspic run out/beam_motion/fitted.toml

POSITIONS.csv has the columns time [s], marker, x, y, z [m] and optionally sigma, the standard deviation [m], in any
order of rows. The rows at the start of the scene, time = 0, attach the markers to the nearest surface points. Recordings of
motion capture are converted by python3 -m aspic.recordings RECORDING POSITIONS.csv. The initial guess is the scene, which has one body and integrator = "backward_euler".

Parameters: young, poisson, density (a field is scaled by one factor), mass_damping, stiffness_damping, viscosity (keys
mass, stiffness and viscosity of damping), velocity, angular_velocity (three numbers each).

Files: fitted.toml (the scene with the fitted values), fit.json, residuals.csv, fit.svg (needs gnuplot).

Exit codes: 0 done, 2 bad input, 3 not converged, 4 --time-limit came first, 130 interrupted by Ctrl-C, 143 by kill:
the best values so far are written.)");
  command->add_option("SCENE", arguments->scene, "Scene (.toml) or mesh")->required();
  command->add_option("POSITIONS", arguments->positions, "Marker positions (.csv)")->required();
  command->add_option("--fit", arguments->names, "Parameters to fit, separated by commas")
      ->required()
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_option("-o,--out", arguments->out, "Directory of the results; out/NAME_motion by default");
  command->add_option("--set", arguments->overrides, "Override values: material.young=2e5; several may follow")
      ->allow_extra_args(false);
  command->add_option("--threads", arguments->threads, "Threads; all cores by default; the result is the same")
      ->check(CLI::Range(1, 1024));
  command->add_option("--time-limit", arguments->time_limit, "Maximum wall time [s]")->check(CLI::Range(1e-3, 1e9));
  command->add_option("--max-iterations", arguments->max_iterations, "Maximum iterations, 100 by default")
      ->check(CLI::Range(1, 100000));
  command->add_flag("--force", arguments->force, "Replace the files of an earlier fit");
  command->add_flag("--json", arguments->json, "Print JSON instead of a table");
  command->callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

}  // namespace aspic::cli
