#include "results/run_directory.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/printable.h"
#include "dynamics/internal_terms.h"
#include "io/atomic_file.h"
#include "io/checkpoint.h"
#include "io/checksum.h"
#include "io/vtu.h"
#include "results/run_directory_frame.h"
#include "results/run_directory_layout.h"
#include "results/run_directory_skins.h"
#include "results/run_directory_tables.h"
#include "results/run_folder.h"
#include "results/run_lock.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// Names in checkpoints.
constexpr char kFrameChecksums[] = "frame_checksums", kSkinChecksums[] = "skin_checksums";

State to_user(const Renumbering& vertex, const State& stored) {
  return {vertex.to_user(stored.q, 3), vertex.to_user(stored.qdot, 3), stored.time};
}

State from_user(const Renumbering& vertex, const State& user) {
  return {vertex.from_user(user.q, 3), vertex.from_user(user.qdot, 3), user.time};
}

// Empty, or the level of an adaptive step, then the start of the last step or substep if it is stored.
std::vector<double> to_history(const Simulation::Snapshot& snapshot, const Renumbering& vertex) {
  if (snapshot.level == 0 && !snapshot.previous) return {};
  std::vector<double> history = {snapshot.level};
  if (!snapshot.previous) return history;
  const State previous = to_user(vertex, *snapshot.previous);
  history.push_back(previous.time);
  history.insert(history.end(), previous.q.begin(), previous.q.end());
  history.insert(history.end(), previous.qdot.begin(), previous.qdot.end());
  return history;
}

void read_history(const std::vector<double>& history, const Renumbering& vertex, Simulation::Snapshot& snapshot) {
  const size_t n = snapshot.state.q.size();
  if (history.size() > 1 && history.size() != 2 + 2 * n)
    throw InvalidInput("the checkpoint's history has " + std::to_string(history.size()) +
                       " entries; this scene needs " + std::to_string(2 + 2 * n));
  if (!history.empty()) snapshot.level = history[0];
  if (history.size() <= 1) return;
  const auto q = history.begin() + 2, qdot = q + static_cast<std::ptrdiff_t>(n);
  snapshot.previous = from_user(vertex, {{q, qdot}, {qdot, history.end()}, history[1]});
}

// In the user's numbering, independent of the storage order of the model.
Checkpoint to_checkpoint(const Simulation& simulation, const std::string& scene,
                         const std::vector<double>& frame_times) {
  const Simulation::Snapshot snapshot = simulation.snapshot();
  const Renumbering& vertex = simulation.model().numbering.vertex;
  State state = to_user(vertex, snapshot.state), start = to_user(vertex, snapshot.start);
  Checkpoint checkpoint;
  checkpoint.fingerprint = scene;
  checkpoint.integers = {{"steps_taken", snapshot.steps_taken}};
  checkpoint.arrays = {{"q", std::move(state.q)},
                       {"qdot", std::move(state.qdot)},
                       {"time", {state.time}},
                       {"start_q", std::move(start.q)},
                       {"start_qdot", std::move(start.qdot)},
                       {"start_time", {start.time}},
                       {"history", to_history(snapshot, vertex)},
                       {"outside_work", {snapshot.outside_work}},
                       {"frame_times", frame_times}};
  if (snapshot.obstacle_time && *snapshot.obstacle_time != snapshot.state.time)
    checkpoint.arrays.emplace_back("obstacle_time", std::vector<double>{*snapshot.obstacle_time});
  if (const InternalTerms terms(simulation.model()); !terms.empty())
    checkpoint.arrays.emplace_back("internal",
                                   terms.to_user(snapshot.state.internal, simulation.model().numbering.tet));
  return checkpoint;
}

double only_number(const Checkpoint& checkpoint, const char* name) {
  const std::vector<double>& values = checkpoint.array(name);
  if (values.size() != 1) throw InvalidInput(std::string("the checkpoint has no single number '") + name + "'");
  return values[0];
}

State state_of(const Checkpoint& checkpoint, const std::string& prefix, const Model& model) {
  const State state{checkpoint.array(prefix + "q"), checkpoint.array(prefix + "qdot"),
                    only_number(checkpoint, (prefix + "time").c_str())};
  const size_t n = 3 * static_cast<size_t>(model.rows());
  for (const auto* v : {&state.q, &state.qdot})
    if (v->size() != n)
      throw InvalidInput("the checkpoint has " + std::to_string(v->size()) + " entries; this scene needs " +
                         std::to_string(n));
  return from_user(model.numbering.vertex, state);
}

void read_internal(const Checkpoint& checkpoint, const Model& model, State& state) {
  const InternalTerms terms(model);
  if (terms.empty()) return;
  const std::vector<double>& values = checkpoint.array("internal");
  if (values.size() != terms.size())
    throw InvalidInput("the checkpoint has " + std::to_string(values.size()) +
                       " internal variables; this scene needs " + std::to_string(terms.size()));
  state.internal = terms.from_user(values, model.numbering.tet);
}

Simulation::Snapshot to_snapshot(const Checkpoint& checkpoint, const Model& model) {
  Simulation::Snapshot snapshot;
  const int64_t steps = checkpoint.integer("steps_taken");
  if (steps < 0 || steps > std::numeric_limits<int>::max())
    throw InvalidInput("the checkpoint counts " + std::to_string(steps) + " steps; it is damaged");
  snapshot.steps_taken = static_cast<int>(steps);
  snapshot.state = state_of(checkpoint, "", model);
  snapshot.start = state_of(checkpoint, "start_", model);
  snapshot.outside_work = only_number(checkpoint, "outside_work");
  if (checkpoint.find("obstacle_time")) snapshot.obstacle_time = only_number(checkpoint, "obstacle_time");
  read_history(checkpoint.array("history"), model.numbering.vertex, snapshot);
  read_internal(checkpoint, model, snapshot.state);
  return snapshot;
}

}  // namespace

struct RunDirectory::Impl {
  Impl(RunLayout where, const Scene& scene)
      : layout(std::move(where)),
        output(scene.output),
        scene_fingerprint(fingerprint(scene.resolved)),
        obstacles(layout, scene) {}

  // Frame index of `time`; times are sums of rounded steps, hence the tolerance.
  double frame_slot(double time) const { return std::floor(time / output.every + 1e-6); }

  bool is_frame_due(double time) const {
    return frame_times.empty() || output.every <= 0 || frame_slot(time) > frame_slot(frame_times.back());
  }

  void write_index() const {
    std::vector<std::pair<double, std::string>> frames;
    std::vector<std::string> others;
    if (!output.vtu) return;
    for (const double time : frame_times) {
      const int frame = static_cast<int>(frames.size());
      frames.emplace_back(time, frame_files[frame]);
      if (!obstacles.at_start().empty()) others.push_back(obstacles.file_of(frame));
    }
    write_pvd(layout.index(), frames, others);
  }

  // Frames that the checkpoint counts are not computed again.
  void require_frames(int count) {
    for (int frame = 0; frame < count && output.vtu; ++frame) {
      frame_files.push_back(layout.file_of_frame(frame));
      const fs::path file = layout.root() / frame_files.back();
      std::error_code error;
      if (const auto size = fs::file_size(file, error); error || size == 0)
        throw InvalidInput(file.string() + ": " + (error ? "is missing" : "is empty") +
                           ", so the run cannot be continued; restore it, or restart the run with --force");
    }
  }

  std::vector<fs::path> files_of_frame(int frame) const {
    std::vector<fs::path> files = skins->files_of_frame(frame);
    if (output.vtu) files.push_back(layout.root() / frame_files[frame]);
    for (fs::path& file : obstacles.files_of_frame(frame)) files.push_back(std::move(file));
    return files;
  }

  void add_checksums(int frame) {
    for (const fs::path& file : files_of_frame(frame)) frame_checksums.push_back(file_checksum(file).value());
  }

  // Compares the frames that the checkpoint counts with their checksums. Checkpoints of several processes have none.
  void check_frames(int count, const Checkpoint& checkpoint) {
    const std::vector<double>* written = checkpoint.find(kFrameChecksums);
    for (int frame = 0; frame < count; ++frame) {
      const size_t first = frame_checksums.size();
      add_checksums(frame);
      const std::vector<fs::path> files = files_of_frame(frame);
      for (size_t i = 0; i < files.size() && written && first + i < written->size(); ++i)
        require_unchanged(files[i], (*written)[first + i], frame_checksums[first + i]);
    }
    if (const std::vector<double>* of_skins = checkpoint.find(kSkinChecksums)) skins->require_unchanged(*of_skins);
  }

  // The scene of the run was checked; comments may have changed.
  void restore_scene(Scene& scene) const {
    if (read_file(layout.scene()) == scene.resolved) return;
    write_file(layout.scene(), scene.resolved);
    scene.notes.push_back(layout.scene().string() + ": its text had changed, but not its values; it was written again");
  }

  void add_frame(const Simulation& simulation, const StepReport* report) {
    const int frame = static_cast<int>(frame_times.size());
    if (output.vtu) {
      frame_files.push_back(RunLayout::frame_file(frame));
      write_frame(layout.root() / frame_files.back(), simulation, report, {output.double_precision, output.mechanics});
    }
    skins->add_frame(frame, simulation.state().q);
    frame_times.push_back(simulation.state().time);
    obstacles.add_frame(frame, simulation.obstacle_time());
    add_checksums(frame);
    skins->write_usd_when_doubled(frame_times, obstacles);
  }

  // Everything that a checkpoint counts is on the disk before it. The index is written with it: rewriting it for every
  // frame would take quadratic time.
  void save_checkpoint(const Simulation& simulation) {
    write_index();
    tables.sync();
    skins->sync();
    Checkpoint checkpoint = to_checkpoint(simulation, scene_fingerprint, frame_times);
    if (obstacles.times != frame_times) checkpoint.arrays.emplace_back("obstacle_times", obstacles.times);
    checkpoint.arrays.emplace_back(kFrameChecksums, frame_checksums);
    checkpoint.arrays.emplace_back(kSkinChecksums, skins->checksums());
    tables.add_sizes(checkpoint);
    write_checkpoint(layout.checkpoint(), checkpoint);
    last_checkpoint = Clock::now();
  }

  bool is_checkpoint_due(bool has_frame) const {
    if (output.checkpoint_every <= 0) return has_frame;
    return std::chrono::duration<double>(Clock::now() - last_checkpoint).count() >= output.checkpoint_every;
  }

  RunLayout layout;
  std::optional<RunLock> lock;
  OutputOptions output;
  std::string scene_fingerprint;
  RunObstacles obstacles;
  std::vector<double> frame_times;       // [s]
  std::vector<std::string> frame_files;  // relative to the root; empty without VTU
  std::vector<double> frame_checksums;   // of files_of_frame(), frame by frame
  RunTables tables;
  std::optional<RunSkins> skins;
  Clock::time_point last_checkpoint = Clock::now();
};

RunDirectory::RunDirectory(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
RunDirectory::~RunDirectory() = default;
RunDirectory::RunDirectory(RunDirectory&&) noexcept = default;

RunDirectory RunDirectory::create(const std::string& path, const Scene& scene, ExistingRun existing) {
  auto impl = std::make_unique<Impl>(RunLayout(path), scene);
  const RunLayout& layout = impl->layout;
  const OutputOptions& output = scene.output;
  std::error_code error;
  if (!fs::exists(path, error)) create_folder(path);
  impl->lock.emplace(path);
  make_room(layout, inputs_of(scene), existing);
  impl->tables = RunTables::create(layout, scene.simulation);
  impl->tables.add_start(scene.simulation.start_report());
  write_inputs(scene, path);
  write_file(layout.scene(), scene.resolved);
  if (output.vtu || output.obj || output.ply) create_folder(layout.frames());
  if ((output.pc2 || output.usd) && !scene.skins.empty()) create_folder(layout.skins());
  impl->obstacles.write_start();
  impl->skins = RunSkins::create(layout, scene);
  impl->add_frame(scene.simulation, nullptr);
  impl->save_checkpoint(scene.simulation);
  return RunDirectory(std::move(impl));
}

RunDirectory RunDirectory::resume(const std::string& path, Scene& scene) {
  auto impl = std::make_unique<Impl>(RunLayout(path), scene);
  const RunLayout& layout = impl->layout;
  impl->lock.emplace(path);
  require_checkpoint(layout);
  const NewestCheckpoint newest = read_newest_checkpoint(layout.checkpoint());
  require_same_scene(layout, scene.resolved, newest.checkpoint.fingerprint);
  scene.simulation.restore(to_snapshot(newest.checkpoint, scene.simulation.model()));
  if (!newest.note.empty()) {
    scene.notes.push_back(newest.note);
    std::error_code ignored;  // the damaged one must not replace the good one
    fs::remove(layout.checkpoint(), ignored);
  }
  impl->frame_times = newest.checkpoint.array("frame_times");
  const std::vector<double>* obstacle_times = newest.checkpoint.find("obstacle_times");
  impl->obstacles.times = obstacle_times ? *obstacle_times : impl->frame_times;
  if (impl->obstacles.times.size() != impl->frame_times.size())
    throw InvalidInput("the checkpoint has obstacles of another number of frames; it is damaged");
  const int frames = static_cast<int>(impl->frame_times.size());
  impl->require_frames(frames);
  impl->tables = RunTables::resume(layout, scene.simulation);
  impl->tables.require_unchanged(newest.checkpoint);
  impl->skins = RunSkins::resume(layout, scene, frames);
  impl->check_frames(frames, newest.checkpoint);
  impl->restore_scene(scene);
  impl->obstacles.write_start();
  layout.remove_unfinished();
  impl->write_index();
  layout.remove_frames_from(frames);
  return RunDirectory(std::move(impl));
}

void RunDirectory::on_iteration(int step, const Iteration& iteration) { impl_->tables.add(step, iteration); }

void RunDirectory::on_step(const StepReport& report, const Simulation& simulation) {
  impl_->tables.add(report);
  const bool has_frame = impl_->is_frame_due(report.time);
  if (has_frame) impl_->add_frame(simulation, &report);
  if (impl_->is_checkpoint_due(has_frame)) impl_->save_checkpoint(simulation);
}

void RunDirectory::finish(const Simulation& simulation) {
  impl_->save_checkpoint(simulation);
  impl_->skins->write_usd(impl_->frame_times, impl_->obstacles);
  std::error_code ignored;  // the previous checkpoint depends on interruptions; results must not
  fs::remove(previous_checkpoint(impl_->layout.checkpoint()), ignored);
  impl_->skins->close();
  impl_->tables.close();
}

bool RunDirectory::is_frame_due(double time) const { return impl_->is_frame_due(time); }
std::string RunDirectory::path() const { return impl_->layout.root(); }
std::string RunDirectory::trace_folder(int first_step) const { return impl_->layout.trace(first_step); }

std::string scene_of_run(const std::string& run) {
  const RunLayout layout(run);
  std::error_code error;
  if (!fs::exists(layout.scene(), error)) {
    throw InvalidInput(run + ": contains no run to continue (scene.toml is missing)" +
                       (layout.holds_run() ? "; it ended before its start: restart it with --force" : ""));
  }
  return layout.scene();
}

}  // namespace aspic
