#include "results/run_directory_layout.h"

#include <algorithm>
#include <fstream>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>

#include "base/error.h"
#include "base/formatted.h"
#include "base/number_chars.h"
#include "io/atomic_file.h"
#include "io/checkpoint.h"
#include "io/input_file.h"
#include "results/run_directory_tables.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;

// Returns the number in a file name of frame_file, pieces_file, piece_file, skin_frame, obstacle_frame_file or
// obstacle_frame.
std::optional<int> frame_number(const fs::path& file) {
  const std::string stem = file.stem().string(), extension = file.extension().string();
  constexpr std::string_view kPiece = "piece_";
  const bool is_piece = extension == ".vtu" && stem.starts_with(kPiece);
  const size_t begin = is_piece ? kPiece.size() : stem.rfind('_') + 1;
  const std::string digits = stem.substr(begin, is_piece ? stem.find('_', begin) - begin : std::string::npos);
  const bool is_frame = stem == "body_" + digits || stem == "obstacles_" + digits;
  const bool is_vtu = is_piece || (extension == ".pvtu" && is_frame) || (extension == ".vtu" && is_frame);
  const bool is_surface =
      (extension == ".obj" || extension == ".ply") && (stem.starts_with("skin_") || stem.starts_with("obstacle_"));
  if (!(is_vtu || is_surface) || digits.size() < 6) return {};
  int number = 0;
  const auto [end, error] = from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc() || end != digits.data() + digits.size() || number < 0) return {};
  return number;
}

bool is_skin_file(const fs::path& file) {
  return file.filename().string().starts_with("skin_") && (file.extension() == ".obj" || file.extension() == ".pc2");
}

bool is_obstacle_file(const fs::path& file) {
  const std::string name = file.filename().string();
  return name == "obstacles.vtu" || (name.starts_with("obstacle_") && file.extension() == ".obj");
}

bool is_unfinished(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.starts_with(".aspic-") || name == "run.usda.unfinished" || name == "checkpoint.previous.bin.new";
}

void remove_file(const fs::path& file) {
  std::error_code error;
  fs::remove(file, error);
  if (error) throw InvalidInput(file.string() + ": cannot be removed: " + error.message());
}

bool is_trace_file(const fs::path& file) {
  const std::string name = file.filename().string();
  return name == "iterations.csv" || name == "trials.csv" || name == "timings.csv" || name == "trace.jsonl" ||
         name.starts_with("curve_") || name.starts_with("slice_");
}

std::vector<fs::path> trace_folders(const fs::path& root) {
  std::error_code error;
  std::vector<fs::path> folders;
  for (fs::directory_iterator entry(root, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    const bool is_trace = name == "trace" || name.starts_with("trace_after_");
    if (is_trace && fs::is_directory(entry->symlink_status())) folders.push_back(entry->path());
  }
  return folders;
}

// Whether a run writes this file directly into its folder.
bool is_name_of_run(const fs::path& file) {
  const std::string name = file.filename().string();
  const RunLayout layout("");
  for (const fs::path& known :
       {layout.scene(), layout.steps(), layout.iterations(), layout.timings(), layout.ranks(), layout.checkpoint(),
        previous_checkpoint(layout.checkpoint()), layout.index(), layout.usd(), layout.report(), layout.outcome(),
        layout.frames(), layout.skins(), layout.obstacles()})
    if (name == known.filename()) return true;
  return name.starts_with("trace") || is_unfinished(file);
}

template <class Condition>
std::vector<fs::path> files_in(const fs::path& folder, Condition is_wanted) {
  std::error_code error;
  std::vector<fs::path> files;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (!fs::is_directory(entry->symlink_status()) && is_wanted(entry->path())) files.push_back(entry->path());
  }
  return files;
}

// Returns the files that the run's scene calls "inputs/...".
std::vector<fs::path> named_inputs(const fs::path& root, const fs::path& scene) {
  std::error_code error;
  if (!fs::is_regular_file(scene, error) || fs::is_symlink(root / "inputs", error)) return {};
  const std::string text = read_file(scene);
  constexpr std::string_view kFolder = "inputs/";
  std::vector<fs::path> files;
  for (size_t start = text.find(kFolder); start != std::string::npos; start = text.find(kFolder, start + 1)) {
    const std::string name = text.substr(start, text.find_first_of("\"'\n", start) - start);
    const fs::path file = root / name;
    const bool is_plain = name.find('/', kFolder.size()) == std::string::npos;
    if (is_plain && name.find("..") == std::string::npos && fs::is_regular_file(file, error)) files.push_back(file);
  }
  return files;
}

}  // namespace

std::string RunLayout::frame_file(int frame) { return formatted("frames/body_%06d.vtu", frame); }

std::string RunLayout::pieces_file(int frame) { return formatted("frames/body_%06d.pvtu", frame); }

std::string RunLayout::piece_file(int frame, int rank) { return formatted("frames/piece_%06d_%05d.vtu", frame, rank); }

std::string RunLayout::file_of_frame(int frame) const {
  std::error_code error;
  return fs::exists(root_ / pieces_file(frame), error) ? pieces_file(frame) : frame_file(frame);
}

std::string RunLayout::obstacle_frame_file(int frame) { return formatted("frames/obstacles_%06d.vtu", frame); }

fs::path RunLayout::obstacle_frame(const std::string& name, int frame) const {
  return frames() / ("obstacle_" + name + formatted("_%06d.obj", frame));
}

fs::path RunLayout::skin_frame(const std::string& skin, int frame, const std::string& extension) const {
  return frames() / ("skin_" + skin + formatted("_%06d", frame) + extension);
}

fs::path RunLayout::trace(int first_step) const {
  return root_ / (first_step == 0 ? "trace" : "trace_after_" + std::to_string(first_step));
}

bool RunLayout::holds_run() const {
  std::ifstream in = try_open_input(steps());
  std::string head(std::string_view(kStepsHead).size(), '\0');
  return in.read(head.data(), static_cast<std::streamsize>(head.size())) && head == kStepsHead;
}

void RunLayout::refuse_links() const {
  // Inputs are replaced before a run begins and not written afterwards.
  aspic::refuse_links(root_,
                      [&](const fs::path& file) { return is_name_of_run(*file.lexically_relative(root_).begin()); });
}

bool RunLayout::is_barely_begun() const {
  std::error_code error;
  for (fs::directory_iterator entry(root_, error), end; !error && entry != end; entry.increment(error))
    if (fs::is_directory(entry->symlink_status()) ? !fs::is_empty(entry->path(), error)
                                                  : !is_unfinished(entry->path()) && entry->path() != outcome())
      return false;
  return !error;
}

void RunLayout::remove_run(const std::vector<fs::path>& needed) const {
  remove_unfinished();
  // First files that allow resuming, and indices.
  std::vector<fs::path> files = {checkpoint(), previous_checkpoint(checkpoint()), index(), usd(), report(), outcome()};
  for (const fs::path& file : named_inputs(root_, scene())) files.push_back(file);
  for (const fs::path& file : files_in(frames(), [](const fs::path& f) { return frame_number(f).has_value(); })) {
    files.push_back(file);
  }
  for (const fs::path& file : files_in(skins(), is_skin_file)) files.push_back(file);
  for (const fs::path& file : files_in(obstacles(), is_obstacle_file)) files.push_back(file);
  std::vector<fs::path> folders = trace_folders(root_);
  for (const fs::path& folder : folders) {
    for (const fs::path& file : files_in(folder, is_trace_file)) files.push_back(file);
  }
  // The table of steps last: without it the directory is no run.
  files.insert(files.end(), {scene(), iterations(), timings(), ranks(), steps()});
  for (const fs::path& file : files) {
    const auto is_same = [&](const fs::path& other) {
      std::error_code error;
      return fs::equivalent(file, other, error);
    };
    if (std::none_of(needed.begin(), needed.end(), is_same)) remove_file(file);
  }
  folders.insert(folders.end(), {frames(), skins(), obstacles(), root_ / "inputs"});
  for (const fs::path& folder : folders) {
    std::error_code not_empty;
    fs::remove(folder, not_empty);
  }
}

void RunLayout::remove_frames_from(int first) const {
  const auto is_later = [&](const fs::path& file) {
    const std::optional<int> number = frame_number(file);
    return number && *number >= first;
  };
  for (const fs::path& file : files_in(frames(), is_later)) remove_file(file);
}

void RunLayout::remove_unfinished() const {
  for (const fs::path& folder : {root_, frames(), skins(), obstacles(), root_ / "inputs"}) {
    for (const fs::path& file : files_in(folder, is_unfinished)) remove_file(file);
  }
}

std::vector<std::string> file_names(const std::vector<std::string>& names) {
  std::set<std::string> taken;  // in lower case, for case-insensitive file systems
  std::vector<std::string> files;
  for (const std::string& name : names) {
    std::string word;
    for (const char c : name) {
      const bool fits =
          (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
      word += fits ? c : '_';
    }
    word = word.empty() ? "_" : word.substr(0, 100);
    const auto is_new = [&](std::string candidate) {
      std::transform(candidate.begin(), candidate.end(), candidate.begin(),
                     [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
      return taken.insert(candidate).second;
    };
    std::string unique = word;
    for (int i = 2; !is_new(unique); ++i) unique = word + "-" + std::to_string(i);
    files.push_back(unique);
  }
  return files;
}

}  // namespace aspic
