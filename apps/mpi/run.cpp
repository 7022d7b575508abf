#include "mpi/run.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <atomic>
#include <csignal>
#include <filesystem>
#include <optional>

#include "base/error.h"
#include "base/printable.h"
#include "base/stopwatch.h"
#include "distributed/distributed_simulation.h"
#include "distributed/guarded.h"
#include "distributed/supported_scene.h"
#include "scene/explanation.h"
#include "scene/run_directory.h"
#include "scene/scene.h"
#include "scene/scene_document.h"
#include "scene/scene_model.h"

namespace aspic::mpi {
namespace {

namespace fs = std::filesystem;

constexpr int kDone = 0, kBadInput = 2, kUnconverged = 3, kStopped = 4, kSignal = 128;

std::atomic<int> received = 0;
static_assert(std::atomic<int>::is_always_lock_free, "the handler may only touch lock-free state");

void catch_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGUSR1}) std::signal(signal, [](int s) { received = s; });
}

// What rank 0 has besides its share: the whole scene and the files.
struct Recorder {
  Scene scene;
  RunDirectory directory;
};

Recorder open(const RunArguments& arguments) {
  const SceneOptions options = {.overrides = arguments.overrides, .require = distributed::require_supported};
  if (arguments.resume) {
    const std::string directory = arguments.out.empty() ? arguments.input : arguments.out;
    if (!fs::is_directory(directory)) throw InvalidInput(directory + ": no run to resume; start it without --resume");
    Scene scene = load_scene(scene_of_run(directory), options);
    distributed::require_vertex_per_rank(scene.simulation.model().mesh);
    RunDirectory opened = RunDirectory::resume(directory, scene);
    return {std::move(scene), std::move(opened)};
  }
  Scene scene = load_scene(arguments.input, options);
  distributed::require_vertex_per_rank(scene.simulation.model().mesh);
  const std::string path = arguments.out.empty() ? (fs::path("out") / scene.name).string() : arguments.out;
  RunDirectory created =
      RunDirectory::create(path, scene, arguments.force ? ExistingRun::overwrite : ExistingRun::refuse);
  return {std::move(scene), std::move(created)};
}

std::vector<std::string> materials_of(const Table& document) {
  std::vector<std::string> names;
  for (const Value& body : document.find("body")->array()) names.push_back(body["material"]["model"].text());
  return names;
}

std::string text_of_rank_0(std::string text) {
  std::vector<double> size = {static_cast<double>(text.size())};
  distributed::broadcast(size);
  std::vector<double> characters(text.begin(), text.end());
  characters.resize(static_cast<size_t>(size[0]));
  distributed::broadcast(characters);
  return {characters.begin(), characters.end()};
}

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

// Simulates the steps; rank 0 records them.
class Runner {
 public:
  Runner(const RunArguments& arguments, std::optional<Recorder> recorder)
      : arguments_(arguments), recorder_(std::move(recorder)) {
    if (recorder_) directory_ = recorder_->directory.path();
    directory_ = text_of_rank_0(directory_);
    load();
  }

  int run() {
    if (recorder_ && !arguments_.quiet) print_start();
    while (simulation_->steps_taken() < steps_ && signal_ == 0) {
      step();
      signal_ = distributed::largest_of_ranks(received);
    }
    if (recorder_) recorder_->directory.finish(recorder_->scene.simulation);
    finish();
    if (signal_ == SIGUSR1) return kStopped;
    if (signal_ != 0) return kSignal + signal_;
    return unconverged_ > 0 && !arguments_.allow_unconverged ? kUnconverged : kDone;
  }

 private:
  // Ranks other than 0 read the resolved scene, which has the same bits.
  void load() {
    double steps = recorder_ ? recorder_->scene.steps : 0;
    distributed::broadcast({&steps, 1});
    steps_ = arguments_.steps > 0 ? arguments_.steps : static_cast<int>(steps);
    if (recorder_) {
      const Simulation& whole = recorder_->scene.simulation;
      const Table document = read_scene_document(recorder_->scene.resolved, scene_of_run(directory_));
      simulation_.emplace(distributed::WholeProblem{whole.model(), materials_of(document), whole.options()},
                          whole.snapshot());
    } else {
      const SceneModel whole = load_scene_model(scene_of_run(directory_));
      simulation_.emplace(distributed::WholeProblem{whole.model, materials_of(whole.document), whole.options},
                          Simulation::Snapshot{});
    }
  }

  void step() {
    std::vector<Iteration> iterations;
    StepReport report = simulation_->step([&](const LiveIteration& iteration) { iterations.push_back(iteration); });
    const Simulation::Snapshot whole = simulation_->gather();
    newton_ += report.iterations;
    linear_ += report.linear_iterations;
    if (!is_success(report.status)) ++unconverged_;
    if (!recorder_) return;
    Simulation& recorded = recorder_->scene.simulation;
    recorded.restore(whole);
    report.state_hash = recorded.state_hash();
    for (const Iteration& iteration : iterations) recorder_->directory.on_iteration(report.step, iteration);
    recorder_->directory.on_step(report, recorded);
    if (!is_success(report.status)) warn(report);
  }

  void warn(const StepReport& report) {
    constexpr int kShown = 5;
    if (unconverged_ > kShown) return;
    const Explanation why = explain(recorder_->scene.simulation, report);
    fmt::print(stderr, "warning: step {} did not converge: {}; {}; {}{}\n", report.step, to_string(report.status),
               why.cause, why.remedy, unconverged_ == kShown ? " (further failures are only counted)" : "");
  }

  void print_start() const {
    const Scene& scene = recorder_->scene;
    for (const std::string& note : scene.notes) fmt::print("note: {}\n", note);
    const TetMesh& mesh = scene.simulation.model().mesh;
    fmt::print("{}: {} vertices, {} tets; {}, {}; {} ranks; into {}\n", scene.name, mesh.vertex_count(),
               mesh.tet_count(), scene.simulation.options().integrator, simulation_->solver_description(),
               distributed::rank_count(), printable(directory_));
    if (simulation_->steps_taken() > 0) fmt::print("resuming after step {}\n", simulation_->steps_taken());
    std::fflush(stdout);
  }

  // The largest memory of ranks that do not record shows what a share needs.
  void finish() {
    const int own = static_cast<int>(peak_megabytes());
    const int recording = distributed::largest_of_ranks(recorder_ ? own : 0);
    const int others = distributed::largest_of_ranks(recorder_ ? 0 : own);
    if (!recorder_ || arguments_.quiet) return;
    fmt::print("{} steps, {} Newton iterations, {} linear iterations, {:.2f} s\n", simulation_->steps_taken(), newton_,
               linear_, stopwatch_.lap());
    if (unconverged_ > 0) fmt::print("{} steps did not converge\n", unconverged_);
    fmt::print("peak memory {} MB on rank 0, {} MB on the others\n", recording, others);
    if (signal_ != 0) fmt::print("stopped by signal {}; --resume continues\n", signal_);
    fmt::print("state hash {:016x}\n", recorder_->scene.simulation.state_hash());
  }

  const RunArguments& arguments_;
  std::optional<Recorder> recorder_;  // only on rank 0
  std::string directory_;
  std::optional<distributed::DistributedSimulation> simulation_;
  Stopwatch stopwatch_;
  int steps_ = 0, signal_ = 0;
  int newton_ = 0, linear_ = 0, unconverged_ = 0;
};

}  // namespace

int run(const RunArguments& arguments) {
  std::optional<Recorder> recorder;
  if (!distributed::succeeds_on(0, [&] { recorder.emplace(open(arguments)); })) return kBadInput;
  catch_signals();
  Runner runner(arguments, std::move(recorder));
  return runner.run();
}

}  // namespace aspic::mpi
