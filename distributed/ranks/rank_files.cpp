#include "ranks/rank_files.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/number_text.h"
#include "io/vtu.h"
#include "ranks/exchange.h"
#include "ranks/guarded.h"
#include "ranks/rank_checkpoint.h"
#include "ranks/rank_frames.h"
#include "results/run_directory_tables.h"
#include "results/run_folder.h"
#include "results/run_lock.h"

namespace aspic::distributed {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

}  // namespace

struct RankFiles::Impl {
  explicit Impl(const RunPlan& plan)
      : layout(plan.path),
        output(plan.output),
        scene_fingerprint(fingerprint(plan.resolved)),
        is_writer(rank_of_this_process() == 0) {}

  // Frame index of `time`; times are sums of rounded steps, hence the tolerance.
  double frame_slot(double time) const { return std::floor(time / output.every + 1e-6); }
  bool is_frame_due(double time) const {
    return frame_times.empty() || output.every <= 0 || frame_slot(time) > frame_slot(frame_times.back());
  }

  // Decided by the clock of rank 0.
  bool is_checkpoint_due(bool has_frame) const {
    double is_due = has_frame ? 1 : 0;
    if (output.checkpoint_every > 0) {
      const double seconds = std::chrono::duration<double>(Clock::now() - last_checkpoint).count();
      is_due = is_writer && seconds >= output.checkpoint_every ? 1 : 0;
      broadcast({&is_due, 1});
    }
    return is_due > 0;
  }

  void add_frame(const DistributedSimulation& simulation, const StepReport* report) {
    const int frame = static_cast<int>(frame_times.size());
    if (output.vtu) {
      write_pieces(layout, simulation, report, {frame, output.double_precision});
      frame_files.push_back(simulation.share().ranks() == 1 ? RunLayout::frame_file(frame)
                                                            : RunLayout::pieces_file(frame));
    }
    frame_times.push_back(simulation.local().state().time);
  }

  void write_index() const {
    if (!output.vtu) return;
    std::vector<std::pair<double, std::string>> frames;
    for (size_t frame = 0; frame < frame_times.size(); ++frame)
      frames.emplace_back(frame_times[frame], frame_files[frame]);
    write_pvd(layout.index(), frames);
  }

  // Everything that a checkpoint counts is on the disk before it.
  void save_checkpoint(const DistributedSimulation& simulation) {
    CheckpointFacts facts;
    succeeds_on(0, [&] {
      write_index();
      tables.sync();
      Checkpoint sizes;
      tables.add_sizes(sizes);
      facts = {scene_fingerprint, frame_times, sizes.integers};
    });
    write_slices(layout.checkpoint(), simulation.local().snapshot(), simulation.user_order(), facts);
    last_checkpoint = Clock::now();
  }

  void require_frames() {
    for (size_t frame = 0; frame < frame_times.size() && output.vtu; ++frame) {
      frame_files.push_back(layout.file_of_frame(static_cast<int>(frame)));
      const fs::path file = layout.root() / frame_files.back();
      std::error_code error;
      if (const auto size = fs::file_size(file, error); error || size == 0)
        throw InvalidInput(file.string() + ": " + (error ? "is missing" : "is empty") +
                           ", so the run cannot be continued; restore it, or restart the run with --force");
    }
  }

  // One row per rank: its share, memory and communication.
  void write_ranks(const DistributedSimulation& simulation) const {
    const MeshShare& share = simulation.share();
    const LinearTraffic& linear = simulation.linear_traffic();
    const double iterations = std::max(1.0, linear.iterations);
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const std::vector<double> all = gather_all(
        std::vector<double>{double(share.rank), double(share.own()), double(share.local_vertices() - share.own()),
                            double(share.user_tet.size()), double(usage.ru_maxrss) * 1024, linear.iterations,
                            linear.messages / iterations, linear.bytes / iterations, linear.reductions / iterations});
    succeeds_on(0, [&] {
      std::string text =
          "rank,vertices,ghosts,tets,peak_bytes,linear_iterations,messages_per_iteration,bytes_per_iteration,"
          "reductions_per_iteration\n";
      constexpr size_t kColumns = 9;
      for (size_t i = 0; i < all.size(); ++i) {
        append_number(text, all[i]);
        text += (i + 1) % kColumns == 0 ? "\n" : ",";
      }
      write_file(layout.ranks(), text);
    });
  }

  RunLayout layout;
  OutputOptions output;
  std::string scene_fingerprint;
  bool is_writer;                        // rank 0
  std::vector<double> frame_times;       // [s]
  std::vector<std::string> frame_files;  // relative to the root
  Clock::time_point last_checkpoint = Clock::now();
  // Only on rank 0:
  std::optional<RunLock> lock;
  RunTables tables;
};

RankFiles::RankFiles(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
RankFiles::~RankFiles() = default;
RankFiles::RankFiles(RankFiles&&) noexcept = default;

RankFiles RankFiles::create(const RunPlan& plan, const SceneInputs& inputs, ExistingRun existing,
                            DistributedSimulation& simulation) {
  auto impl = std::make_unique<Impl>(plan);
  const StepReport start = simulation.start_report();
  succeeds_on(0, [&] {
    const RunLayout& layout = impl->layout;
    std::error_code error;
    if (!fs::exists(plan.path, error)) create_folder(plan.path);
    impl->lock.emplace(plan.path);
    make_room(layout, inputs, existing);
    impl->tables = RunTables::create(layout, simulation.local());
    impl->tables.add_start(start);
    write_inputs(inputs, plan.path);
    write_file(layout.scene(), plan.resolved);
    if (plan.output.vtu) create_folder(layout.frames());
  });
  impl->add_frame(simulation, nullptr);
  impl->save_checkpoint(simulation);
  return RankFiles(std::move(impl));
}

RankFiles RankFiles::resume(const RunPlan& plan, DistributedSimulation& simulation, std::vector<std::string>& notes) {
  auto impl = std::make_unique<Impl>(plan);
  const RunLayout& layout = impl->layout;
  succeeds_on(0, [&] {
    impl->lock.emplace(plan.path);
    require_checkpoint(layout);
  });
  RankCheckpoint newest = read_slices(layout.checkpoint(), simulation.user_order());
  succeeds_on(0, [&] {
    require_same_scene(layout, plan.resolved, newest.head.fingerprint);
    impl->frame_times = newest.head.array("frame_times");
  });
  simulation.restore(std::move(newest.own));
  if (!newest.note.empty()) notes.push_back(newest.note);
  double frames = static_cast<double>(impl->frame_times.size());
  broadcast({&frames, 1});
  impl->frame_times.resize(static_cast<size_t>(frames));
  broadcast(impl->frame_times);
  succeeds_on(0, [&] {
    if (!newest.note.empty()) {
      std::error_code ignored;  // the damaged one must not replace the good one
      fs::remove(layout.checkpoint(), ignored);
    }
    impl->require_frames();
    impl->tables = RunTables::resume(layout, simulation.local());
    impl->tables.require_unchanged(newest.head);
    layout.remove_unfinished();
    impl->write_index();
    layout.remove_frames_from(static_cast<int>(frames));
  });
  impl->frame_files.resize(impl->output.vtu ? impl->frame_times.size() : 0);  // used on rank 0
  return RankFiles(std::move(impl));
}

void RankFiles::on_step(const StepReport& report, const std::vector<Iteration>& iterations,
                        const DistributedSimulation& simulation) {
  succeeds_on(0, [&] {
    for (const Iteration& iteration : iterations) impl_->tables.add(report.step, iteration);
    impl_->tables.add(report);
  });
  const bool has_frame = impl_->is_frame_due(report.time);
  if (has_frame) impl_->add_frame(simulation, &report);
  if (impl_->is_checkpoint_due(has_frame)) impl_->save_checkpoint(simulation);
}

void RankFiles::finish(const DistributedSimulation& simulation) {
  impl_->save_checkpoint(simulation);
  impl_->write_ranks(simulation);
  succeeds_on(0, [&] {
    std::error_code ignored;  // the previous checkpoint depends on interruptions; results must not
    fs::remove(previous_checkpoint(impl_->layout.checkpoint()), ignored);
    impl_->tables.close();
  });
}

}  // namespace aspic::distributed
