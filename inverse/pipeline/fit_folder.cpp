#include "pipeline/fit_folder.h"

#include <algorithm>
#include <sstream>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/csv.h"
#include "io/input_file.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;

const char* const kHistoryHead =
    "stage,iteration,start,weight,misfit,roughness,objective,decrement,step,inner,trials\n";

fs::path options_file(const fs::path& folder) { return folder / "options.toml"; }
fs::path history_file(const fs::path& folder) { return folder / "history.csv"; }

// Files that only an unfinished fit has.
std::vector<fs::path> journals(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.ends_with(".journal") || name.ends_with(".state")) files.push_back(entry->path());
  }
  return files;
}

void remove_file(const fs::path& file) {
  std::error_code error;
  fs::remove(file, error);
  if (error) throw InvalidInput(file.string() + ": cannot be removed: " + error.message());
}

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

// Options without comments, which state their origins.
std::vector<std::string> options_in(const std::string& text) {
  std::vector<std::string> lines = lines_of(text);
  std::erase_if(lines, [](const std::string& line) { return line.empty() || line.starts_with('#'); });
  return lines;
}

// First difference of two texts: "smooth = "h1" then, smooth = "tv" now".
std::string difference(const std::string& then, const std::string& now) {
  const std::vector<std::string> a = options_in(then), b = options_in(now);
  for (size_t i = 0; i < std::max(a.size(), b.size()); ++i) {
    const std::string one = i < a.size() ? a[i] : "nothing", other = i < b.size() ? b[i] : "nothing";
    if (one != other) return "the stored option is '" + one + "', the new one is '" + other + "'";
  }
  return "";
}

}  // namespace

const char* to_string(FitStage stage) {
  constexpr const char* kNames[] = {"uniform", "mesh_errors",      "field", "uncertainty",
                                    "parts",   "cross_validation", "law",   "relaxation"};
  return kNames[static_cast<size_t>(stage)];
}

bool FitFolder::is_complete(const fs::path& material, const std::string& options) {
  FitFolder folder;
  folder.path_ = fs::path(material).replace_extension(".fit");
  if (!fs::exists(options_file(folder.path_)) || !journals(folder.path_).empty() || !fs::exists(material)) return false;
  folder.require_same(options);
  return true;
}

void FitFolder::require_same(const std::string& options) const {
  const std::string change = difference(read_file(options_file(path_)), options);
  if (!change.empty())
    throw InvalidInput(path_.string() + ": cannot be resumed: " + change + " (the same command, or --force)");
}

FitFolder FitFolder::open(const fs::path& material, const std::string& options, ExistingFit existing) {
  FitFolder folder;
  folder.path_ = fs::path(material).replace_extension(".fit");
  const fs::path& path = folder.path_;
  std::error_code error;
  const bool is_there = fs::is_directory(path, error);
  if (is_there && existing != ExistingFit::share) folder.lock_ = std::make_shared<const RunLock>(path);
  const bool is_begun = fs::exists(options_file(path)), is_unfinished = !journals(path).empty();
  if (existing == ExistingFit::share) {
    if (!is_begun) throw InvalidInput(path.string() + ": no fit has been begun; the command without --job begins it");
    folder.require_same(options);
    folder.start_ = JournalStart::read;
    return folder;
  }
  if (existing == ExistingFit::proceed) existing = is_begun ? ExistingFit::resume : ExistingFit::overwrite;
  if (existing != ExistingFit::refuse) refuse_links(path, [](const fs::path&) { return true; });
  if (existing == ExistingFit::resume) {
    if (!is_begun) throw InvalidInput(path.string() + ": no fit to resume; start it without --resume");
    if (!is_unfinished)
      throw InvalidInput(path.string() + ": this fit is complete; --force replaces it, -o writes another");
    folder.require_same(options);
    folder.start_ = JournalStart::resume;
    if (fs::exists(history_file(path)))
      folder.rows_on_disk_ = std::max(0, static_cast<int>(lines_of(read_file(history_file(path))).size()) - 1);
    folder.history_ = kHistoryHead;
    return folder;
  }
  if (existing == ExistingFit::refuse && is_unfinished)
    throw InvalidInput(path.string() + ": contains an interrupted fit; --resume continues it, --force replaces it");
  if (existing == ExistingFit::refuse && (is_begun || fs::exists(material)))
    throw InvalidInput((is_begun ? path : material).string() + ": exists; --force replaces it, -o writes another");
  fs::create_directories(path, error);
  if (error) throw InvalidInput(path.string() + ": cannot be created: " + error.message());
  if (!is_there) folder.lock_ = std::make_shared<const RunLock>(path);
  // A journal exists until the end, so that a fit killed at its start does not count as complete.
  const fs::path begun = path / "begun.journal";
  write_file(begun, "");
  for (const fs::path& file : journals(path))
    if (file != begun) remove_file(file);
  fs::remove_all(folder.jobs(), error);
  for (const char* name : {"history.csv", "weights.csv", "report.html", "jobs.txt", "slurm.sh"})
    if (fs::exists(path / name)) remove_file(path / name);
  write_file(options_file(path), options);
  folder.history_ = kHistoryHead;
  return folder;
}

void FitFolder::add(FitStage stage, const FitIteration& i) {
  CsvRow row;
  row.add(to_string(stage)).add(i.index).add(i.start).add(i.weight).add(i.misfit).add(i.roughness).add(i.objective);
  row.add(i.decrement).add(i.step).add(i.inner).add(i.trials);
  history_ += row.text() + "\n";
  if (++rows_ <= rows_on_disk_) return;
  write_file(history_file(path_), history_);
}

void FitFolder::add_weights(const FitReport& report) {
  if (report.weights.empty()) return;
  std::string text = "weight,misfit,roughness\n";
  for (const WeightTrial& trial : report.weights) {
    CsvRow row;
    row.add(trial.weight).add(trial.misfit).add(trial.roughness);
    text += row.text() + "\n";
  }
  write_file(path_ / "weights.csv", text);
}

void FitFolder::finish() {
  std::error_code error;
  fs::remove_all(jobs(), error);
  for (const char* name : {"jobs.txt", "slurm.sh"}) fs::remove(path_ / name, error);
  for (const fs::path& file : journals(path_)) remove_file(file);
}

}  // namespace aspic
