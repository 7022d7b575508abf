#include "run_files.h"

#include "base/error.h"
#include "io/atomic_file.h"
#include "results/run_directory.h"
#include "results/trace.h"
#include "several_files.h"

namespace aspic::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr char kScene[] =
    "[time]\nduration = 0.1\nstep = 0.01\n[[body]]\nname = \"a\"\nshape = { box = { lower = [0, 0, 0], "
    "upper = [1, 1, 1], cells = [1, 1, 1] } }\n[[body.pin]]\nwhere = \"y < 0.5\"\n";

}  // namespace

SceneOptions small_scenes() {
  return {.mesher = "/nonexistent", .limit = {.tets = kMaxTets, .why = "are fuzzed", .counts_files = true}};
}

Folder::Folder(const fs::path& path) {
  for (const auto& entry : fs::recursive_directory_iterator(path))
    if (entry.is_regular_file()) files_.emplace_back(fs::relative(entry.path(), path), read_file(entry.path()));
}

const std::string& Folder::contents(const fs::path& name) const {
  for (const auto& [known, bytes] : files_)
    if (known == name) return bytes;
  throw InvalidInput("the run has no " + name.string());
}

void Folder::restore(const fs::path& path) const {
  fs::remove_all(path);
  for (const auto& [name, contents] : files_) {
    fs::create_directories((path / name).parent_path());
    put_file(path / name, contents);
  }
}

Folder begun_run(int steps) {
  const fs::path run = folder_of_process() / "begun", scene_file = folder_of_process() / "begun.toml";
  put_file(scene_file, kScene);
  Scene scene = load_scene(scene_file);
  RunDirectory directory = RunDirectory::create(run, scene, ExistingRun::overwrite);
  Trace trace(directory.trace_folder(0));
  for (int step = 1; step <= steps; ++step) {
    const StepReport report = scene.simulation.step([&](const LiveIteration& iteration) {
      directory.on_iteration(step, iteration);
      trace.on_iteration(step, iteration);
    });
    directory.on_step(report, scene.simulation);
  }
  directory.finish(scene.simulation);
  return Folder(run);
}

void make_checkpoint_right(const fs::path& path, std::string_view fingerprint) {
  if (fs::exists(path)) put_file(path, with_right_checksum(with_fingerprint(read_file(path), fingerprint)));
}

}  // namespace aspic::fuzz
