#include "program/run.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <atomic>
#include <csignal>
#include <filesystem>
#include <optional>

#include "aspic/step_loop.h"
#include "aspic/summary.h"
#include "base/error.h"
#include "base/free_memory.h"
#include "base/printable.h"
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
void remove_surfaces(Table& document) {
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
  remove_surfaces(document);
  if (!open_slices(input, ranks_here, opened)) open_whole(std::move(input), options, ranks_here, opened);
  if (opened.run_directory.empty()) opened.run_directory = (fs::path("out") / opened.name).string();
  return opened;
}

const char* remedy_for(Status status) {
  if (status == Status::iteration_limit) return "raise solver.max_iterations, or choose a smaller time.step";
  if (status == Status::round_off) return "choose a larger solver.tolerance";
  return "choose a smaller time.step, or a material that tolerates inversion";
}

// A run on all ranks. Every function is collective unless it is const.
class RankRun : public cli::SteppedRun {
 public:
  // `opened`: on rank 0.
  RankRun(const RunArguments& arguments, Opened opened) : arguments_(arguments), opened_(std::move(opened)) {
    Table document = share_document();
    last_step_ = arguments_.steps > 0 ? arguments_.steps : steps_of(*document.find("time"));
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

  int last_step() const { return last_step_; }
  const Simulation& simulation() const override { return simulation_->local(); }
  int signal() override { return distributed::largest_of_ranks(received); }
  StepReport step(const IterationObserver& observe, const StopToken&) override { return simulation_->step(observe); }

  Explanation record(const StepReport& report, const std::vector<Iteration>& iterations) override {
    files_->on_step(report, iterations, *simulation_);
    if (is_success(report.status)) return {};
    Explanation why{
        .cause = "a force remains that the step did not balance", .place = {}, .remedy = remedy_for(report.status)};
    if (report.worst_vertex < 0) return why;
    const distributed::NamedPlace worst = simulation_->place_of(report.worst_vertex);
    why.place = fmt::format("vertex {} at ({:.4g}, {:.4g}, {:.4g}) m: {:.3g} N", worst.user_vertex, worst.position[0],
                            worst.position[1], worst.position[2], report.worst_residual);
    return why;
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

  // Returns the facts of the summary.
  cli::RunEnd finish(const cli::StepLoop& loop) {
    files_->finish(*simulation_);
    return {.last_step = last_step_,
            .steps_taken = simulation_->steps_taken(),
            .interrupted = signal() != 0,
            .blown_up = loop.has_blown_up(),
            .solver = simulation_->local().solver_description(),
            .precision = cli::precision_of(simulation_->local().options().solver.minimize),
            .state_hash = simulation_->state_hash(),
            .directory = opened_.run_directory,
            .program = fmt::format("mpirun -n {} aspic-mpi", distributed::rank_count())};
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
    remove_surfaces(document);
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

  const RunArguments& arguments_;
  Opened opened_;  // only partly on other ranks
  bool is_sliced_ = false;
  std::optional<distributed::DistributedSimulation> simulation_;
  std::optional<distributed::RankFiles> files_;
  int last_step_ = 0;
};

// The largest memory of ranks other than 0 shows what a share needs. Collective.
void print_memory(bool prints) {
  const int own = static_cast<int>(peak_megabytes());
  const int first = distributed::largest_of_ranks(prints ? own : 0);
  const int others = distributed::largest_of_ranks(prints ? 0 : own);
  if (prints) fmt::print("memory     {} MB on rank 0, at most {} MB on the others\n", first, others);
}

}  // namespace

int run(const RunArguments& arguments) {
  Opened opened;
  const int ranks_here = distributed::ranks_on_this_machine();
  distributed::succeeds_on(0, [&] { opened = open(arguments, ranks_here); });
  catch_signals();
  RankRun all(arguments, std::move(opened));
  const bool prints = distributed::rank_of_this_process() == 0;
  std::FILE* const human = prints && !arguments.quiet ? stdout : nullptr;
  setenv("TERM", "dumb", 1);  // mpirun gives the ranks a terminal whose output may go to a file
  if (human) all.print_start();
  cli::StepLoop loop(all, {.last_step = all.last_step(), .warns = prints, .progress = human, .stop = {}});
  loop.run();
  const cli::RunEnd end = all.finish(loop);
  if (human) cli::print_summary(human, loop.totals(), end);
  if (!arguments.quiet) print_memory(prints);
  const int signal = all.signal();
  if (signal == SIGUSR1) return kStopped;
  if (signal != 0) return kSignal + signal;
  return loop.has_blown_up() || (loop.totals().unconverged > 0 && !arguments.allow_unconverged) ? kUnconverged : kDone;
}

}  // namespace aspic::mpi
