#include "recording/recording.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/error.h"
#include "base/formatted.h"
#include "base/number_chars.h"
#include "base/printable.h"
#include "io/atomic_file.h"
#include "io/csv_reader.h"
#include "recording/dic_tables.h"
#include "recording/file_pattern.h"
#include "recording/formats.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;

std::string lower_extension(const fs::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

// Last number in the name of a file; empty if it has none.
std::optional<int> own_number(const fs::path& file) {
  const std::string stem = file.stem().string();
  const size_t last = stem.find_last_of("0123456789");
  if (last == std::string::npos) return std::nullopt;
  const size_t before = stem.find_last_not_of("0123456789", last);
  const size_t first = before == std::string::npos ? 0 : before + 1;
  int number = 0;
  const auto [end, error] = from_chars(stem.data() + first, stem.data() + last + 1, number);
  return error == std::errc() ? std::optional(number) : std::nullopt;
}

// Frames of a sequence are counted from 1, whatever the numbers in the names of its files.
void note_numbers(const std::vector<fs::path>& files, Recording& recording) {
  const auto frame = [&](size_t i) {
    return "frame " + std::to_string(i + 1) + " = " + printable(files[i].filename().string());
  };
  for (size_t i = 0; i < files.size(); ++i) {
    const std::optional<int> number = own_number(files[i]);
    if (!number || *number == static_cast<int>(i) + 1) continue;
    std::string text = "frames count the files from 1: " + frame(0);
    if (files.size() > 1) text += " to " + frame(files.size() - 1);
    recording.notes.push_back(text);
    return;
  }
}

double typical_interval(const Recording& recording) {
  const std::vector<RecordedFrame>& frames = recording.frames;
  if (frames.size() < 2) return std::numeric_limits<double>::infinity();
  return (frames.back().time - frames.front().time) / static_cast<double>(frames.size() - 1);
}

}  // namespace

bool is_seen(const Vec3d& p) { return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]); }

std::optional<double> length_unit(std::string_view text) {
  static const std::map<std::string, double, std::less<>> units = {
      {"m", 1},     {"meters", 1},         {"cm", 1e-2},   {"centimeters", 1e-2}, {"mm", 1e-3}, {"millimeters", 1e-3},
      {"um", 1e-6}, {"micrometers", 1e-6}, {"in", 0.0254}, {"inches", 0.0254}};
  std::string name;
  for (const char c : text)
    if (!std::isspace(static_cast<unsigned char>(c)) && c != '\0')
      name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const auto found = units.find(name);
  return found == units.end() ? std::nullopt : std::optional(found->second);
}

void make_names_unique(Recording& recording) {
  std::set<std::string> used;
  int renamed = 0;
  for (std::string& name : recording.names) {
    std::string unique = name;
    for (int copy = 2; !used.insert(unique).second; ++copy) unique = name + " (" + std::to_string(copy) + ")";
    if (unique != name) ++renamed, name = unique;
  }
  if (renamed > 0)
    recording.notes.push_back(recording.file + ": " + std::to_string(renamed) +
                              " points share their name with another one; a number was appended");
}

void check_density(size_t frames, size_t points, size_t bytes, const std::string& where) {
  if (points > 0 && frames > bytes / points)
    throw InvalidInput(where + ": " + std::to_string(frames) + " frames of " + std::to_string(points) +
                       " points do not fit into " + std::to_string(bytes) +
                       " bytes; most points would never be seen. Export the points that were tracked");
}

void check_recording(const Recording& recording, size_t bytes) {
  if (recording.names.empty())
    throw InvalidInput(recording.file + ": has no points; export the trajectories of the markers");
  if (recording.frames.empty()) throw InvalidInput(recording.file + ": has no frames; export the recorded range");
  check_density(recording.frames.size(), recording.names.size(), bytes, recording.file);
  for (size_t f = 1; f < recording.frames.size(); ++f) {
    const RecordedFrame &frame = recording.frames[f], &last = recording.frames[f - 1];
    if (frame.number <= last.number)
      throw InvalidInput(frame.where + ": frame " + std::to_string(frame.number) + " follows frame " +
                         std::to_string(last.number) + "; sort the frames, each with its own number");
    if (recording.has_times && !(frame.time > last.time))
      throw InvalidInput(frame.where + ": time = " + six_digits(frame.time) + " s follows " + six_digits(last.time) +
                         " s; times must ascend");
  }
}

int frame_numbered(const Recording& recording, int number) {
  const std::vector<RecordedFrame>& frames = recording.frames;
  const auto found = std::lower_bound(frames.begin(), frames.end(), number,
                                      [](const RecordedFrame& f, int n) { return f.number < n; });
  if (found == frames.end() || found->number != number)
    throw InvalidInput("frame " + std::to_string(number) + " is not in " + recording.file + ", which has the frames " +
                       std::to_string(frames.front().number) + " to " + std::to_string(frames.back().number));
  return static_cast<int>(found - frames.begin());
}

int frame_at(const Recording& recording, double time) {
  const std::vector<RecordedFrame>& frames = recording.frames;
  if (!recording.has_times)
    throw InvalidInput(recording.file + " has no times; select frames by the column frame instead of time");
  size_t best = 0;
  for (size_t f = 1; f < frames.size(); ++f)
    if (std::abs(frames[f].time - time) < std::abs(frames[best].time - time)) best = f;
  if (!(std::abs(frames[best].time - time) <= 0.5 * typical_interval(recording)))
    throw InvalidInput("time = " + six_digits(time) + " s is not in " + recording.file + ", which lasts from " +
                       six_digits(frames.front().time) + " s to " + six_digits(frames.back().time) + " s");
  return static_cast<int>(best);
}

bool is_recording(const fs::path& path) {
  const std::string extension = lower_extension(path);
  if (is_pattern(path) || extension == ".trc" || extension == ".c3d" || extension == ".npz" || extension == ".ply" ||
      extension == ".obj")
    return true;
  std::error_code error;
  if (!fs::is_regular_file(path, error) || fs::file_size(path, error) == 0) return false;
  const CsvReader csv(path, CsvOrigin::foreign);
  return !csv.has("case") && dialect_of(csv.columns()) != nullptr;
}

Recording read_recording(const fs::path& path) {
  const std::vector<fs::path> files = matching_files(path);
  const std::string file = printable(path.string()), extension = lower_extension(path);
  if (extension != ".trc" && extension != ".c3d" && extension != ".npz") {
    Recording sequence =
        extension == ".ply" || extension == ".obj" ? read_surface_sequence(files) : read_dic_tables(files);
    if (is_pattern(path)) note_numbers(files, sequence);
    return sequence;
  }
  if (files.size() > 1)
    throw InvalidInput(file + ": matches " + std::to_string(files.size()) + " files, but " + extension +
                       " files hold all frames; name one of them");
  const std::string contents = read_file(files[0]);
  if (extension == ".trc") return parse_trc(file, contents);
  return extension == ".c3d" ? parse_c3d(file, contents) : parse_npz(file, contents);
}

}  // namespace aspic
