// `aspic modes`: computes natural frequencies and mode shapes of a scene.
#include "dynamics/modes.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "aspic/commands.h"
#include "base/parallel.h"
#include "base/printable.h"
#include "base/stop_token.h"
#include "io/csv.h"
#include "mesh/box.h"
#include "results/run_directory.h"
#include "scene/scene.h"

namespace aspic::cli {
namespace {

namespace fs = std::filesystem;

struct ModesArguments {
  fs::path input, out;
  std::vector<std::string> overrides;
  std::string about = "rest";
  int count = 10, threads = 0;  // 0: all cores
  double time_limit = 0;        // [s]; 0: none
  bool force = false, json = false, quiet = false;
};

constexpr double kAmplitude = 0.1;  // largest displacement of a frame, relative to the size of the model

struct Frame {
  double amplitude = 0;  // largest displacement [m]
  StepReport report;
};

double largest_displacement(std::span<const double> shape) {
  double square = 0;
  for (size_t i = 0; i < shape.size(); i += 3)
    square = std::max(square, shape[i] * shape[i] + shape[i + 1] * shape[i + 1] + shape[i + 2] * shape[i + 2]);
  return std::sqrt(square);
}

void move_to_rest(Simulation& simulation) {
  State rest = simulation.state();
  const std::vector<Vec3d>& X = simulation.model().mesh.rest;
  for (size_t i = 0; i < rest.q.size(); ++i) rest.q[i] = i / 3 < X.size() ? X[i / 3][static_cast<int>(i % 3)] : 0;
  simulation.restore({.state = rest, .start = rest});
}

// Moves the simulation to start + amplitude * shape, as step `number` at the time `number`. The amplitude is halved
// until no tet is inverted.
Frame show_mode(Simulation& simulation, const State& start, const Mode& mode, int number) {
  double amplitude = kAmplitude * longest_side(bounding_box(simulation.model().mesh.rest));
  const double largest = largest_displacement(mode.shape);
  while (true) {
    Simulation::Snapshot snapshot{.state = start, .start = start, .steps_taken = number};
    snapshot.state.time = number;
    for (size_t i = 0; i < mode.shape.size(); ++i) snapshot.state.q[i] += amplitude / largest * mode.shape[i];
    simulation.restore(snapshot);
    StepReport report = simulation.start_report();
    report.step = number;
    report.time = number;
    if (report.min_det_F > 0 || amplitude < 1e-6 * kAmplitude) return {amplitude, std::move(report)};
    amplitude /= 2;
  }
}

void write_frames(const ModesArguments& arguments, Scene& scene, const Modes& found) {
  const fs::path out = arguments.out.empty() ? fs::path("out") / (scene.name + "_modes") : arguments.out;
  scene.resolved += "# Steps are modes: this run cannot be continued.\n";  // a different scene, so --resume refuses it
  scene.output.every = 0;
  scene.output.vtu = true;
  State start = scene.simulation.state();
  std::fill(start.qdot.begin(), start.qdot.end(), 0.0);
  RunDirectory directory =
      RunDirectory::create(out, scene, arguments.force ? ExistingRun::overwrite : ExistingRun::refuse);
  CsvFile table = CsvFile::create(out / "modes.csv", {"mode", "frequency", "rigid", "amplitude"});
  for (size_t k = 0; k < found.modes.size(); ++k) {
    const int number = static_cast<int>(k) + 1;
    const Frame frame = show_mode(scene.simulation, start, found.modes[k], number);
    directory.on_step(frame.report, scene.simulation);
    table.append(
        CsvRow().add(number).add(found.modes[k].frequency).add(number <= found.rigid ? 1 : 0).add(frame.amplitude));
  }
  table.close();
  directory.finish(scene.simulation);
}

void print_json(const Modes& found) {
  nlohmann::ordered_json list = nlohmann::json::array();
  for (size_t k = 0; k < found.modes.size(); ++k)
    list.push_back(
        {{"mode", k + 1}, {"frequency", found.modes[k].frequency}, {"rigid", static_cast<int>(k) < found.rigid}});
  fmt::print("{}\n", nlohmann::ordered_json{{"rigid", found.rigid}, {"modes", list}}.dump(2));
}

void print_table(const Modes& found, int wanted) {
  fmt::print("{:>4} {:>14} {:>14}\n", "mode", "frequency [Hz]", "period [s]");
  for (size_t k = 0; k < found.modes.size(); ++k) {
    const double f = found.modes[k].frequency;
    if (static_cast<int>(k) < found.rigid)
      fmt::print("{:>4} {:>14} {:>14}  rigid motion\n", k + 1, 0, "-");
    else
      fmt::print("{:>4} {:>14.6g} {:>14.6g}\n", k + 1, f, 1 / f);
  }
  if (found.rigid > 0)
    fmt::print("{} {} no stiffness: pins and springs leave {} free\n", found.rigid,
               found.rigid == 1 ? "mode has" : "modes have", found.rigid == 1 ? "this motion" : "these motions");
  if (static_cast<int>(found.modes.size()) < wanted) fmt::print("the model has only {} modes\n", found.modes.size());
}

int compute(const ModesArguments& arguments) {
  const WallClock clock = steady_seconds;
  const StopToken limit = arguments.time_limit > 0 ? StopToken(clock, arguments.time_limit) : StopToken();
  if (arguments.threads > 0) set_thread_count(arguments.threads);
  Scene scene = load_scene(arguments.input, {.overrides = arguments.overrides, .mesher_seconds = arguments.time_limit});
  if (!arguments.json && !arguments.quiet)
    for (const std::string& note : scene.notes) fmt::print("note: {}\n", note);
  if (arguments.about == "rest") move_to_rest(scene.simulation);
  const Modes found = vibration_modes(scene.simulation.model(), scene.simulation.state().q, arguments.count, limit);
  if (found.status != ModesStatus::converged) {
    fmt::print(stderr, "error: {}: {}\n", printable(arguments.input.string()), message(found.status));
    if (found.status == ModesStatus::interrupted) return exit_time_limit;
    return found.status == ModesStatus::unconverged ? exit_unconverged : exit_bad_input;
  }
  write_frames(arguments, scene, found);
  if (arguments.json)
    print_json(found);
  else if (!arguments.quiet)
    print_table(found, arguments.count);
  return exit_done;
}

}  // namespace

void add_modes(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<ModesArguments>();
  CLI::App* command = app.add_subcommand("modes", "Computes natural frequencies and mode shapes of a scene");
  command->footer(R"(
Examples:
  aspic modes scenes/beam.toml                   the ten lowest frequencies, mode shapes in out/beam_modes
  aspic modes bunny.mesh --count 20 --json
  aspic view out/beam_modes                      frame 3 is mode 3

The vibrations are small and undamped, about the rest shape without stress; pins are held. With --about start they are
about the positions at which the scene starts, and stress there changes the frequencies. A motion without stiffness,
such as each of the six rigid motions of a free body, has the frequency 0.

Files: modes.csv (mode, frequency [Hz], rigid, amplitude [m]) and a directory like that of a run, in which step k is
mode k, scaled to displacements of at most a tenth of the model's size. ParaView opens run.pvd.

Exit codes: 0 done, 2 bad input, 3 not converged, 4 time limit.)");
  command->add_option("INPUT", arguments->input, "Scene (.toml) or mesh")->required();
  command->add_option("--count", arguments->count, "Number of modes, 10 by default")->check(CLI::Range(1, 10000));
  command->add_option("--about", arguments->about, "Positions about which to vibrate: rest (default) or start")
      ->check(CLI::IsMember({"rest", "start"}));
  command->add_option("--set", arguments->overrides, "Override values: material.young=2e5; several may follow")
      ->allow_extra_args(false);
  command->add_option("--out", arguments->out, "Directory of the results; out/NAME_modes by default");
  command->add_flag("--force", arguments->force, "Replace the results of an earlier run");
  command->add_option("--threads", arguments->threads, "Threads; all cores by default; results do not depend on it")
      ->check(CLI::Range(1, 1024));
  command->add_option("--time-limit", arguments->time_limit, "Maximum wall time [s]")->check(CLI::Range(1e-3, 1e9));
  command->add_flag("-q,--quiet", arguments->quiet, "Print only errors");
  command->add_flag("--json", arguments->json, "Print JSON instead of a table");
  command->callback([arguments, &action] { action = [arguments] { return compute(*arguments); }; });
}

}  // namespace aspic::cli
