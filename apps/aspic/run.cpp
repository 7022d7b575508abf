// `aspic run`: loads a scene or a mesh, simulates the steps and records them.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <optional>

#include "aspic/commands.h"
#include "aspic/interrupt.h"
#include "aspic/landscape_picture.h"
#include "aspic/run_report.h"
#include "aspic/step_json.h"
#include "aspic/step_loop.h"
#include "aspic/summary.h"
#include "aspic/sweep/outcome.h"
#include "base/error.h"
#include "base/free_memory.h"
#include "base/parallel.h"
#include "base/printable.h"
#include "base/stop_token.h"
#include "contact/barrier.h"
#include "dynamics/internal_terms.h"
#include "dynamics/mesh_error_text.h"
#include "dynamics/state.h"
#include "mesh/elements.h"
#include "results/explanation.h"
#include "results/run_directory.h"
#include "results/run_directory_layout.h"
#include "results/run_folder.h"
#include "results/trace.h"
#include "scene/scene.h"

namespace aspic::cli {
namespace {

namespace fs = std::filesystem;

struct RunArguments {
  fs::path input, out;
  std::vector<std::string> overrides, landscapes;
  int threads = 0, steps = 0;  // 0: not given
  double time_limit = 0;       // [s]; 0: not given
  bool force = false, resume = false, continues = false, trace = false, quiet = false, json = false,
       allow_unconverged = false;
};

std::vector<LandscapeAt> landscapes(const RunArguments& arguments) {
  std::vector<LandscapeAt> places;
  for (const std::string& text : arguments.landscapes) places.push_back(parse_landscape(text));
  return places;
}

// Directory to continue: the given one, or the default directory of the input.
fs::path directory_to_resume(const RunArguments& arguments) {
  if (!arguments.out.empty()) return arguments.out;
  if (fs::is_directory(arguments.input)) return arguments.input;
  return fs::path("out") / arguments.input.stem();
}

std::FILE* human_stream(const RunArguments& arguments) { return arguments.json ? stderr : stdout; }

// Announces long preparations before they begin.
void announce(const RunArguments& arguments, const std::string& what) {
  if (arguments.quiet) return;
  fmt::print(human_stream(arguments), "{} ...\n", what);
  std::fflush(human_stream(arguments));
}

constexpr int kManyTets = 300'000;  // a frame of this size takes a second to write

// Before the scene is loaded: filling a surface with tets may take minutes.
void refuse_earlier_results(const RunArguments& arguments) {
  const bool is_known =
      !arguments.out.empty() || arguments.input.extension() != ".toml";  // a scene has a name of its own
  if (is_known && !arguments.force && !arguments.continues && fs::exists(arguments.input))
    refuse_run(RunLayout(directory_to_resume(arguments)));
}

Scene load(const RunArguments& arguments) {
  const Announce announced = [&](const std::string& what) { announce(arguments, what); };
  if (arguments.resume) {
    if (!arguments.overrides.empty()) {
      throw InvalidInput("--set and --resume cannot be combined: a run continues with its own scene");
    }
    const fs::path directory = directory_to_resume(arguments);
    if (!fs::is_directory(directory)) {
      throw InvalidInput(fmt::format("{}: no run to resume; start it without --resume", directory.string()));
    }
    return load_scene(scene_of_run(directory), {.announce = announced, .mesher_seconds = arguments.time_limit});
  }
  if (fs::is_directory(arguments.input)) {
    throw InvalidInput(
        fmt::format("{0}: is a directory; to continue a run: aspic run {0} --resume", arguments.input.string()));
  }
  refuse_earlier_results(arguments);
  return load_scene(arguments.input,
                    {.overrides = arguments.overrides, .announce = announced, .mesher_seconds = arguments.time_limit});
}

RunDirectory open_directory(const RunArguments& arguments, Scene& scene) {
  if (arguments.resume || (arguments.continues && has_checkpoint(directory_to_resume(arguments))))
    return RunDirectory::resume(directory_to_resume(arguments), scene);
  const bool is_named = !arguments.out.empty() || arguments.continues;
  const fs::path path = is_named ? directory_to_resume(arguments) : fs::path("out") / scene.name;
  // Without a checkpoint nothing is lost.
  const bool replaces = arguments.force || (arguments.continues && RunLayout(path).holds_run());
  if (scene.simulation.model().mesh.tet_count() >= kManyTets) announce(arguments, "writing the first frame");
  return RunDirectory::create(path, scene, replaces ? ExistingRun::overwrite : ExistingRun::refuse);
}

// A run in this process, with its trace.
class LocalRun : public SteppedRun {
 public:
  LocalRun(const RunArguments& arguments, Scene& scene, RunDirectory& directory)
      : arguments_(arguments), scene_(scene), directory_(directory) {
    if (const Barrier* contact = scene.simulation.model().contact; contact && scene.simulation.steps_taken() == 0)
      for (const ContactPart& part : contact->mesh().parts) untouched_.push_back(part.is_obstacle ? part.name : "");
    if (!arguments.trace && arguments.landscapes.empty()) return;
    const LineSearchOptions& line_search = scene.simulation.options().solver.minimize.line_search;
    trace_.emplace(directory.trace_folder(scene.simulation.steps_taken()),
                   TraceOptions{landscapes(arguments), line_search.sufficient_decrease});
  }

  const Simulation& simulation() const override { return scene_.simulation; }
  int signal() override { return interrupt_signal(); }

  StepReport step(const IterationObserver& observe, const StopToken& stop) override {
    const auto traced = [&](const LiveIteration& iteration) {
      if (trace_) trace_->on_iteration(scene_.simulation.steps_taken() + 1, iteration);
      observe(iteration);
    };
    StepReport report = scene_.simulation.step(traced, stop);
    if (!is_success(report.status) || !wants_mesh_error(report)) return report;
    if (is_short())
      report.mesh_error = "no estimate: it would take longer than the run; aspic check SCENE --mesh-error computes it";
    else
      add_mesh_error(scene_.simulation, {}, report);  // not interrupted: a resumed run has the same bits
    return report;
  }

  Explanation record(const StepReport& report, const std::vector<Iteration>& iterations) override {
    for (const Iteration& iteration : iterations) directory_.on_iteration(report.step, iteration);
    directory_.on_step(report, scene_.simulation);
    if (report.contacts > 0) note_touches();
    Explanation why = explain(scene_.simulation, report);
    if (arguments_.json) {
      fmt::print("{}\n", step_json(report, why, scene_.simulation));
      std::fflush(stdout);
    }
    return why;
  }

  // Names of obstacles that no body touched at the end of a step. Empty for a resumed run, whose first part is unknown.
  std::vector<std::string> untouched() const {
    std::vector<std::string> names = untouched_;
    names.erase(std::remove(names.begin(), names.end(), ""), names.end());
    return names;
  }

  void finish() {
    directory_.finish(scene_.simulation);
    if (trace_) finish_trace();
  }

 private:
  void note_touches() {
    if (untouched().empty()) return;
    const State& state = scene_.simulation.state();
    for (const ContactStencil& stencil : *scene_.simulation.model().contact->stencils(state.q, state.time))
      for (const int part : stencil.parts) untouched_[part].clear();
  }

  // Not after --steps: the rows of a run do not depend on where it was interrupted.
  bool wants_mesh_error(const StepReport& report) const {
    if (scene_.simulation.model().mesh.tets.empty()) return false;  // of sheets there is no estimate
    return (scene_.mesh_error == "frames" && directory_.is_frame_due(report.time)) ||
           (scene_.mesh_error != "off" && report.step == scene_.steps);
  }

  // An estimate costs about as much as 60 iterations.
  bool is_short() const {
    constexpr int kFewSteps = 12, kMostTets = 20'000;
    return scene_.steps < kFewSteps && scene_.simulation.model().mesh.tet_count() > kMostTets;
  }

  void finish_trace() {
    trace_->close();
    for (const LandscapeAt& at : trace_->missed())
      fmt::print(stderr, "warning: no landscape {0}:{1}: the run has no iteration {1} of step {0}\n", at.step,
                 at.iteration);
    draw_landscapes();
    if (!arguments_.quiet)
      fmt::print(human_stream(arguments_), "trace      {}\n", printable(trace_->folder().string()));
  }

  void draw_landscapes() const {
    try {
      for (const Landscape& landscape : trace_->landscapes()) {
        const std::string name = landscape_name(landscape.at);
        draw(trace_->folder() / ("curve_" + name + ".svg"), line_search_chart(landscape));
        draw(trace_->folder() / ("slice_" + name + ".png"), slice_surface(landscape));
      }
    } catch (const InvalidInput& missing) {
      fmt::print(stderr, "note: no pictures: {}\n", missing.what());
    }
  }

  const RunArguments& arguments_;
  Scene& scene_;
  RunDirectory& directory_;
  std::optional<Trace> trace_;
  std::vector<std::string> untouched_;  // one per part of the contact; empty: touched, or a body
};

void print_start(std::FILE* stream, const RunArguments& arguments, const Scene& scene, const fs::path& directory) {
  const Simulation& simulation = scene.simulation;
  for (const std::string& note : scene.notes) fmt::print(stream, "note: {}\n", note);
  fmt::print(stream, "{}: {}; {}, {}; {} threads; into {}\n", scene.name, size_text(simulation.model().mesh),
             simulation.options().integrator, simulation.solver_description(), thread_count(), directory.string());
  if (arguments.resume || simulation.steps_taken() > 0)
    fmt::print(stream, "resuming after step {}\n", simulation.steps_taken());
  std::fflush(stream);
}

// Those of prescribed twist, which exert no force, are empty.
std::vector<std::string> pin_names(const Model& model) {
  std::vector<std::string> names;
  const auto is_vertex = [&](int row) { return row < model.mesh.vertex_count(); };
  for (const Pin& pin : model.pins)
    names.push_back(std::any_of(pin.vertices.begin(), pin.vertices.end(), is_vertex) ? pin.name : "");
  return names;
}

int exit_code(const RunArguments& arguments, bool has_run_out, int unconverged) {
  if (interrupt_signal()) return exit_signal + interrupt_signal();
  if (has_run_out) return exit_time_limit;
  if (unconverged > 0 && !arguments.allow_unconverged) return exit_unconverged;
  return exit_done;
}

std::string outcome(const StepLoop& loop, const Scene& scene, int unconverged) {
  const int steps = scene.simulation.steps_taken();
  if (loop.has_blown_up()) return fmt::format("{}: the explicit scheme blew up after step {}", kFailed, steps);
  if (steps < loop.last_step())
    return loop.has_run_out() ? fmt::format("{}: by the time limit", kStopped)
                              : fmt::format("{}: by signal {}", kStopped, interrupt_signal());
  return unconverged > 0 ? kUnconverged : kDone;
}

// Returns an integrator of order 2 that supports the model, if the present one is backward Euler.
std::string better_scheme(const Simulation& simulation) {
  if (!simulation.integrator().is_backward_euler || !InternalTerms(simulation.model()).empty()) return "";
  return simulation.options().adaptive.tolerance > 0 ? "tr_bdf2" : "bdf2";
}

int report_complete(const RunArguments& arguments, const fs::path& directory, int last_step) {
  const int unconverged = count_steps(directory, last_step).unconverged;
  const std::string failures = unconverged > 0 ? fmt::format("; {} did not converge", unconverged) : "";
  if (!arguments.quiet)
    fmt::print(human_stream(arguments), "{}: all {} steps are computed{}\n", directory.string(), last_step, failures);
  return exit_code(arguments, false, unconverged);
}

int run(const RunArguments& arguments) {
  const WallClock clock = steady_seconds;
  StopToken stop([] { return interrupt_signal() != 0; });
  if (arguments.time_limit > 0) stop = stop.with_deadline(clock, arguments.time_limit);
  if (arguments.threads > 0) set_thread_count(arguments.threads);
  landscapes(arguments);  // throws for bad input before anything is written
  keep_freed_memory();
  Scene scene = load(arguments);
  const int last_step = arguments.steps > 0 ? arguments.steps : scene.steps;
  if (arguments.continues && is_complete(directory_to_resume(arguments), scene, last_step))
    return report_complete(arguments, directory_to_resume(arguments), last_step);
  RunDirectory directory = open_directory(arguments, scene);
  catch_interrupts();  // from here on there are results to keep
  if (arguments.continues) write_outcome(directory.path(), running_here());

  const int earlier = count_steps(directory.path(), scene.simulation.steps_taken()).unconverged;

  LocalRun local(arguments, scene, directory);
  std::FILE* const human = arguments.quiet ? nullptr : human_stream(arguments);
  StepLoop loop(local, {.last_step = last_step, .progress = human, .stop = stop});
  if (human) print_start(human, arguments, scene, directory.path());
  if (!scene.start_warning.empty()) fmt::print(stderr, "warning: {}\n", scene.start_warning);
  loop.run();
  local.finish();
  if (human) {
    if (earlier > 0) fmt::print(human, "{} of the earlier steps did not converge\n", earlier);
    print_summary(human, loop.totals(),
                  {.last_step = last_step,
                   .steps_taken = scene.simulation.steps_taken(),
                   .interrupted = interrupt_signal() != 0,
                   .time_limit = loop.has_run_out() ? arguments.time_limit : 0,
                   .blown_up = loop.has_blown_up(),
                   .solver = scene.simulation.integrator().is_implicit ? scene.simulation.solver_description() : "",
                   .precision = precision_of(scene.simulation.options().solver.minimize),
                   .start_warning = scene.start_warning,
                   .better_scheme = better_scheme(scene.simulation),
                   .inverted = inverted_tets(scene.simulation),
                   .state_hash = scene.simulation.state_hash(),
                   .untouched = local.untouched(),
                   .pins = pin_names(scene.simulation.model()),
                   .directory = directory.path()});
  }
  write_run_report(directory.path(), scene, human);
  const int unconverged = earlier + loop.totals().unconverged;
  if (arguments.continues) write_outcome(directory.path(), outcome(loop, scene, unconverged));
  if (loop.has_blown_up()) return exit_unconverged;  // --allow-unconverged does not apply to an unfinished run
  return exit_code(arguments, loop.has_run_out(), unconverged);
}

int run_recorded(const RunArguments& arguments) {
  if (!arguments.continues) return run(arguments);
  return recorded(directory_to_resume(arguments), [&] { return run(arguments); });
}

}  // namespace

int run_scene(const fs::path& scene, const fs::path& out) {
  RunArguments arguments;
  arguments.input = scene, arguments.out = out, arguments.continues = true;
  return run_recorded(arguments);
}

void add_run(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<RunArguments>();
  CLI::App* command = app.add_subcommand("run", "Simulates a scene, or a mesh with defaults");
  command->footer(R"(
Examples:
  aspic run bunny.obj                             fill the surface with tets; it falls onto a floor
  aspic run scenes/bunny.toml                     results in out/bunny
  aspic run beam.toml --set material.young=2e5 time.step=0.005 --out out/soft
  aspic run beam.toml --resume                    continue an interrupted run, bit-reproducibly
  aspic run beam.toml --out out/a --continue      begin, resume, or do nothing if all steps are computed
  aspic run beam.toml --time-limit 3600           at most an hour; --resume continues
  aspic run beam.toml --json | jq .iterations     one line of JSON per step
  aspic run beam.toml --landscape 12:0            the first iteration of step 12 in detail

Exit codes: 0 done, 2 bad input, 3 some step did not converge (unless --allow-unconverged, or because its
solver.time_budget ended it) or an explicit scheme blew up, which ends the run;
4 time limit; 130 interrupted by Ctrl-C, 143 by kill: all complete steps are written.)");
  command->add_option("INPUT", arguments->input, "Scene (.toml), mesh, or with --resume a run directory")->required();
  command->add_option("--set", arguments->overrides, "Override values: material.young=2e5; several may follow")
      ->allow_extra_args(false);
  command->add_option("--threads", arguments->threads, "Threads; all cores by default; results do not depend on it")
      ->check(CLI::Range(1, 1024));
  command->add_option("--steps", arguments->steps, "Stop after this many steps of the run")
      ->check(CLI::Range(1, 1000000000));
  command
      ->add_option("--time-limit", arguments->time_limit,
                   "Stop after this wall time [s] and discard the step in progress; --resume continues")
      ->check(CLI::Range(1e-3, 1e9));
  command->add_option("--out", arguments->out, "Directory for the results; out/NAME by default");
  command->add_flag("--force", arguments->force, "Replace the results of an earlier run");
  command->add_flag("--resume", arguments->resume, "Continue the run in the directory")->excludes("--force");
  command
      ->add_flag("--continue", arguments->continues,
                 "Begin the run, resume it, or do nothing if all steps are computed; refuses another scene")
      ->excludes("--force")
      ->excludes("--resume");
  command->add_flag("--trace", arguments->trace,
                    "Write every trial of every iteration to DIRECTORY/trace; changes no result");
  command
      ->add_option("--landscape", arguments->landscapes,
                   "STEP or STEP:ITERATION: with the trace, E along the direction of that iteration and over a plane "
                   "through it; can be repeated")
      ->allow_extra_args(false);
  command->add_flag("-q,--quiet", arguments->quiet, "Print only warnings and errors");
  command->add_flag("--json", arguments->json, "Print one line of JSON per step on stdout, all else on stderr");
  command->add_flag("--allow-unconverged", arguments->allow_unconverged, "Exit with 0 even if a step did not converge");
  command->callback([arguments, &action] { action = [arguments] { return run_recorded(*arguments); }; });
}

}  // namespace aspic::cli
