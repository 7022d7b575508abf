#include "results/run_folder.h"

#include <sstream>
#include <system_error>

#include "base/error.h"
#include "base/printable.h"
#include "io/atomic_file.h"
#include "io/checkpoint.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;

// ":12: 'young = 2e5' here, 'young = 1e5' in the run"
std::string first_difference(const std::string& here, const std::string& in_run) {
  std::istringstream ours(here), theirs(in_run);
  for (int line = 1;; ++line) {
    std::string a, b;
    const bool has_a = !!std::getline(ours, a), has_b = !!std::getline(theirs, b);
    if (!has_a && !has_b) return ": it was changed after the run began";
    if (a != b || has_a != has_b)
      return std::string(":")
                 .append(std::to_string(line))
                 .append(": ")
                 .append(shown(a))
                 .append(" now, ")
                 .append(shown(b)) +
             " in the run";
  }
}

}  // namespace

void create_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw InvalidInput(folder.string() + ": cannot be created: " + error.message() +
                       "; choose a writable directory with --out");
}

void refuse_run(const RunLayout& layout) {
  if (!layout.holds_run() || layout.is_barely_begun()) return;
  throw InvalidInput(layout.root().string() + ": already contains a run; --force replaces it, --resume continues it");
}

void make_room(const RunLayout& layout, const SceneInputs& inputs, ExistingRun existing) {
  const std::string name = layout.root().string();
  std::error_code error;
  if (!fs::is_directory(layout.root(), error)) throw InvalidInput(name + ": is a file; results need a directory");
  if (layout.is_barely_begun()) return layout.remove_unfinished();
  if (!layout.holds_run()) {
    throw InvalidInput(name + ": is not empty and contains no run; choose another directory, or empty this one");
  }
  if (existing == ExistingRun::refuse) refuse_run(layout);
  layout.refuse_links();
  std::vector<fs::path> needed;  // inputs of the new run may lie in the old one
  for (const auto& [_, source] : inputs.files) needed.push_back(source);
  layout.remove_run(needed);
}

void require_same_scene(const RunLayout& layout, const std::string& resolved, const std::string& in_checkpoint) {
  if (in_checkpoint == fingerprint(resolved)) return;
  throw InvalidInput(layout.root().string() + ": was computed with another scene; continue with the run's own scene (" +
                     layout.scene().string() + first_difference(resolved, read_file(layout.scene())) + ")");
}

void require_checkpoint(const RunLayout& layout) {
  const std::string path = layout.root().string();
  if (!layout.holds_run()) throw InvalidInput(path + ": contains no run to continue");
  layout.refuse_links();
  std::error_code error;
  if (!fs::exists(layout.checkpoint(), error) && !fs::exists(previous_checkpoint(layout.checkpoint()), error))
    throw InvalidInput(path +
                       ": the run ended before its first checkpoint, so nothing is lost; restart it with --force");
}

}  // namespace aspic
