#include "program/run.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <atomic>
#include <csignal>
#include <filesystem>
#include <optional>

#include "base/error.h"
#include "base/free_memory.h"
#include "base/printable.h"
#include "base/stopwatch.h"
#include "ranks/distributed_simulation.h"
#include "ranks/exchange.h"
#include "ranks/guarded.h"
#include "ranks/mesh_slices.h"
#include "ranks/rank_files.h"
#include "ranks/rank_memory.h"
#include "ranks/scatter.h"
#include "ranks/supported_scene.h"
#include "scene/scene_builder.h"
#include "scene/scene_document.h"
#include "scene/schema.h"
#include "scene/toml_reader.h"

namespace aspic::mpi {
namespace {

namespace fs = std::filesystem;

constexpr int kDone = 0, kUnconverged = 3, kStopped = 4, kSignal = 128;

std::atomic<int> received = 0;
static_assert(std::atomic<int>::is_always_lock_free, "the handler may only touch lock-free state");

void catch_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGUSR1}) std::signal(signal, [](int s) { received = s; });
}

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

// What rank 0 reads.
struct Opened {
  std::string name, run_directory, resolved;
  std::vector<std::string> notes;
  std::vector<std::pair<std::string, std::string>> input_files;
  std::vector<std::pair<std::string, TetMesh>> generated_meshes;
  std::optional<SceneModel> whole;  // empty: each rank makes its part
  // The document for the other ranks, with its file for messages.
  std::string text, file;
  bool has_overrides = false;  // they apply to the text
};

// Frames are pieces of the volume.
void leave_out_surfaces(Table& document) {
  Table& output = document.find("output")->table();
  for (const char* key : {"pc2", "usd", "report"}) output.set(key, {false, {}});
}

void require_vertex_per_rank(double vertices) {
  if (vertices < distributed::rank_count())
    throw InvalidInput(fmt::format("the scene has {:.0f} vertices for {} ranks; use fewer ranks", vertices,
                                   distributed::rank_count()));
}

// Numbers of vertices and tets are 32-bit integers.
void require_numbers(double vertices, double tets) {
  constexpr double kMost = 2147483647;
  if (tets > kMost)
    throw InvalidInput(fmt::format("the scene has {:.3g} tets; at most {:.0f} are supported", tets, kMost));
  require_vertex_per_rank(vertices);
}

// Reports errors of the initial state with the user's numbers.
void require_start(const SceneModel& scene, const std::string& file) {
  try {
    require_finite_energy(scene.model, scene.start.q);
  } catch (const BadInitialState& e) {
    throw InvalidInput(file + ": " + e.cause + "; " + remedy_in_scene(e.kind));
  } catch (const InvalidInput& e) {
    throw InvalidInput(file + ": " + e.what());
  }
}

distributed::MemoryNeed memory_need(const Table& document, double vertices) {
  return {vertices, distributed::rank_count(), (*document.find("solver"))["linear"].text() != "block_jacobi"};
}

// Returns false if the meshes must be read as a whole. `ranks_here`: number of ranks on the machine of rank 0.
bool open_slices(SceneInput& input, int ranks_here, Opened& opened) {
  Table document = input.source.document;
  if (!input.source.meshes.empty()) return false;
  const std::optional<distributed::SlicedBodies> bodies = distributed::sliced_bodies(document, input.files);
  if (!bodies) return false;
  double vertices = 0, tets = 0;
  for (const auto& body : *bodies) vertices += body->vertex_count(), tets += body->tet_count();
  require_numbers(vertices, tets);
  distributed::require_memory(memory_need(document, vertices), ranks_here, static_cast<double>(free_memory()));
  if (!distributed::resolve_slices(*bodies, document, input.files)) return false;
  opened.name = printable(input.source.name);
  opened.notes = std::move(input.source.notes);
  mark_version(document, opened.notes);
  put_in_order(document);
  opened.resolved = to_toml(document);
  opened.input_files = std::move(input.files.kept_files);
  return true;
}

void open_whole(SceneInput input, const SceneOptions& options, int ranks_here, Opened& opened) {
  SceneModel& whole = opened.whole.emplace(build_scene_model(std::move(input.source), std::move(input.files), options));
  require_vertex_per_rank(whole.model.mesh.vertex_count());
  distributed::require_memory(memory_need(whole.document, whole.model.mesh.vertex_count()), ranks_here,
                              static_cast<double>(free_memory()));
  require_start(whole, opened.file);
  opened.name = whole.name;
  opened.notes = std::move(whole.notes);
  opened.input_files = std::move(whole.input_files);
  opened.generated_meshes = std::move(whole.generated_meshes);
  opened.resolved = to_toml(whole.document);
}

// `ranks_here`: number of ranks on the machine of rank 0.
Opened open(const RunArguments& arguments, int ranks_here) {
  Opened opened;
  opened.run_directory = arguments.out;
  fs::path path = arguments.input;
  if (arguments.resume) {
    if (arguments.out.empty()) opened.run_directory = arguments.input;
    if (!fs::is_directory(opened.run_directory))
      throw InvalidInput(opened.run_directory + ": no run to resume; start it without --resume");
    path = scene_of_run(opened.run_directory);
  }
  const SceneOptions options = {.overrides = arguments.overrides};
  SceneInput input = read_scene_input(path, options);
  Table& document = input.source.document;
  distributed::require_supported(document);
  opened.file = path.string();
  opened.has_overrides = path.extension() == ".toml";
  opened.text = opened.has_overrides ? read_toml_text(path) : to_toml(document);
  leave_out_surfaces(document);
  if (!open_slices(input, ranks_here, opened)) open_whole(std::move(input), options, ranks_here, opened);
  if (opened.run_directory.empty()) opened.run_directory = (fs::path("out") / opened.name).string();
  return opened;
}

const char* remedy_for(Status status) {
  if (status == Status::iteration_limit) return "raise solver.max_iterations, or choose a smaller time.step";
  if (status == Status::round_off) return "choose a larger solver.tolerance";
  return "choose a smaller time.step, or a material that tolerates inversion";
}

// Simulates the steps; rank 0 prints.
class Runner {
 public:
  // `opened`: on rank 0.
  Runner(const RunArguments& arguments, Opened opened)
      : arguments_(arguments), opened_(std::move(opened)), prints_(distributed::rank_of_this_process() == 0) {
    Table document = share_document();
    steps_ = arguments_.steps > 0 ? arguments_.steps : steps_of(*document.find("time"));
    const OutputOptions output = output_options(*document.find("output"));
    SceneFiles files(fs::path(opened_.file).parent_path(), false);
    distributed::RankScene scene =
        is_sliced_ ? make_slices(document, files) : distributed::scatter(opened_.whole ? &*opened_.whole : nullptr);
    opened_.whole.reset();
    simulation_.emplace(std::move(scene), std::move(document), std::move(files));
    const std::vector<std::string>& notes = simulation_->notes();
    opened_.notes.insert(opened_.notes.end(), notes.begin(), notes.end());
    open_files({opened_.run_directory, opened_.resolved, output});
  }

  int run() {
    if (prints_ && !arguments_.quiet) print_start();
    while (simulation_->steps_taken() < steps_ && signal_ == 0) {
      step();
      signal_ = distributed::largest_of_ranks(received);
    }
    files_->finish(*simulation_);
    finish();
    if (signal_ == SIGUSR1) return kStopped;
    if (signal_ != 0) return kSignal + signal_;
    return unconverged_ > 0 && !arguments_.allow_unconverged ? kUnconverged : kDone;
  }

 private:
  static distributed::RankScene make_slices(const Table& document, const SceneFiles& files) {
    std::optional<distributed::SlicedBodies> bodies;
    distributed::all_succeed([&] {
      bodies = distributed::sliced_bodies(document, files);
      if (!bodies)
        throw InvalidInput("a mesh file differs from that of rank 0; keep it unchanged until the run starts");
    });
    return distributed::make_mesh_slices(document, *bodies);
  }

  Table share_document() {
    for (std::string* text : {&opened_.text, &opened_.file, &opened_.run_directory, &opened_.resolved})
      *text = distributed::broadcast_text(*text);
    double flags[] = {opened_.has_overrides ? 1.0 : 0.0, opened_.whole ? 0.0 : 1.0};
    distributed::broadcast(flags);
    is_sliced_ = flags[1] > 0;
    const std::vector<std::string> none;
    Table document = read_scene_document(opened_.text, opened_.file, flags[0] > 0 ? arguments_.overrides : none);
    leave_out_surfaces(document);
    return document;
  }

  void open_files(const distributed::RunPlan& plan) {
    if (arguments_.resume) {
      files_.emplace(distributed::RankFiles::resume(plan, *simulation_, opened_.notes));
    } else {
      const SceneInputs inputs{opened_.resolved, opened_.input_files, opened_.generated_meshes};
      files_.emplace(distributed::RankFiles::create(
          plan, inputs, arguments_.force ? ExistingRun::overwrite : ExistingRun::refuse, *simulation_));
    }
    opened_.generated_meshes.clear();
  }

  void step() {
    std::vector<Iteration> iterations;
    const StepReport report =
        simulation_->step([&](const LiveIteration& iteration) { iterations.push_back(iteration); });
    newton_ += report.iterations;
    linear_ += report.linear_iterations;
    files_->on_step(report, iterations, *simulation_);
    if (!is_success(report.status)) {
      ++unconverged_;
      warn(report);
    }
  }

  void warn(const StepReport& report) {
    constexpr int kShown = 5;
    if (unconverged_ > kShown) return;
    std::string place;
    if (report.worst_vertex >= 0) {
      const distributed::NamedPlace worst = simulation_->place_of(report.worst_vertex);
      place = fmt::format("vertex {} at ({:.4g}, {:.4g}, {:.4g}) m is farthest from balance: {:.3g} N remain; ",
                          worst.user_vertex, worst.position[0], worst.position[1], worst.position[2],
                          report.worst_residual);
    }
    if (prints_)
      fmt::print(stderr, "warning: step {} did not converge: {}; {}{}{}\n", report.step, to_string(report.status),
                 place, remedy_for(report.status),
                 unconverged_ == kShown ? " (further failures are only counted)" : "");
  }

  void print_start() const {
    for (const std::string& note : opened_.notes) fmt::print("note: {}\n", note);
    const BodyRange& last = simulation_->share().of_bodies.back();
    const Simulation& local = simulation_->local();
    fmt::print("{}: {} vertices, {} tets; {}, {}; {} ranks, meshes in {}; into {}\n", opened_.name,
               last.first_vertex + last.vertex_count, last.first_tet + last.tet_count, local.options().integrator,
               local.solver_description(), distributed::rank_count(), is_sliced_ ? "slices" : "one piece",
               printable(opened_.run_directory));
    if (simulation_->steps_taken() > 0) fmt::print("resuming after step {}\n", simulation_->steps_taken());
    std::fflush(stdout);
  }

  // The largest memory of ranks other than 0 shows what a share needs.
  void finish() {
    const int own = static_cast<int>(peak_megabytes());
    const int first = distributed::largest_of_ranks(prints_ ? own : 0);
    const int others = distributed::largest_of_ranks(prints_ ? 0 : own);
    const std::uint64_t hash = simulation_->state_hash();
    if (!prints_ || arguments_.quiet) return;
    fmt::print("{} steps, {} Newton iterations, {} linear iterations, {:.2f} s\n", simulation_->steps_taken(), newton_,
               linear_, stopwatch_.lap());
    if (unconverged_ > 0) fmt::print("{} steps did not converge\n", unconverged_);
    fmt::print("peak memory {} MB on rank 0, {} MB on the others\n", first, others);
    if (signal_ != 0) fmt::print("stopped by signal {}; --resume continues\n", signal_);
    fmt::print("state hash {:016x}\n", hash);
  }

  const RunArguments& arguments_;
  Opened opened_;  // only partly on other ranks
  bool prints_;
  bool is_sliced_ = false;
  std::optional<distributed::DistributedSimulation> simulation_;
  std::optional<distributed::RankFiles> files_;
  Stopwatch stopwatch_;
  int steps_ = 0, signal_ = 0;
  int newton_ = 0, linear_ = 0, unconverged_ = 0;
};

}  // namespace

int run(const RunArguments& arguments) {
  Opened opened;
  const int ranks_here = distributed::ranks_on_this_machine();
  distributed::succeeds_on(0, [&] { opened = open(arguments, ranks_here); });
  catch_signals();
  Runner runner(arguments, std::move(opened));
  return runner.run();
}

}  // namespace aspic::mpi
