#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/error.h"
#include "base/formatted.h"
#include "recording/c3d_parameters.h"
#include "recording/formats.h"

namespace aspic {
namespace {

constexpr double kUnseen = std::numeric_limits<double>::quiet_NaN();
constexpr size_t kBlockBytes = 512;

class C3dReader {
 public:
  C3dReader(const std::string& file, std::string_view contents) : bytes_(file, contents), parameters_(bytes_) {
    recording_.file = file;
  }

  Recording read() {
    read_layout();
    read_names();
    read_unit();
    read_rate();
    read_frames();
    make_names_unique(recording_);
    check_recording(recording_, bytes_.size());
    return std::move(recording_);
  }

 private:
  // The header is words of two bytes, counted from 1 in the specification.
  static constexpr size_t word(int n) { return 2 * (static_cast<size_t>(n) - 1); }

  void read_layout() {
    points_ = static_cast<size_t>(bytes_.uint16(word(2)));
    const std::optional<int> used = parameters_.unsigned_integer("POINT:USED");
    if (used && static_cast<size_t>(*used) != points_)
      bytes_.fail(word(2), "the header has " + std::to_string(points_) + " points, but POINT:USED is " +
                               std::to_string(*used) + "; the file is damaged");
    if (points_ == 0) bytes_.fail(word(2), "the file has no points; export the trajectories of the markers");
    scale_ = parameters_.number("POINT:SCALE").value_or(bytes_.real(word(7)));
    if (!std::isfinite(scale_) || scale_ == 0)
      bytes_.fail(word(7), "the scale factor is " + six_digits(scale_) + "; it must be finite and not 0");
    first_frame_ = bytes_.uint16(word(4));
    frame_count_ = count_frames();
    const size_t width = is_real() ? 4 : 2, analog = static_cast<size_t>(bytes_.uint16(word(3)));
    frame_bytes_ = width * (4 * points_ + analog);
    const int block = parameters_.unsigned_integer("POINT:DATA_START").value_or(bytes_.uint16(word(9)));
    if (block < 2)
      bytes_.fail(word(9),
                  "the data begin in block " + std::to_string(block) + ", inside the header; the file is damaged");
    start_ = (static_cast<size_t>(block) - 1) * kBlockBytes;
    const size_t room = start_ < bytes_.size() && frame_bytes_ > 0 ? (bytes_.size() - start_) / frame_bytes_ : 0;
    if (frame_count_ > room)
      bytes_.fail(bytes_.size(), "the file ends after " + std::to_string(room) + " of " + std::to_string(frame_count_) +
                                     " frames; it is cut short, get a complete copy");
  }

  bool is_real() const { return scale_ < 0; }

  // More than 65535 frames are counted by TRIAL, in two words each, or by POINT:LONG_FRAMES.
  size_t count_frames() {
    const auto start = long_count("TRIAL:ACTUAL_START_FIELD"), end = long_count("TRIAL:ACTUAL_END_FIELD");
    if (start && end && *end >= *start) {
      first_frame_ = static_cast<int>(std::min<size_t>(*start, std::numeric_limits<int>::max() / 2));
      return *end - *start + 1;
    }
    const std::optional<double> many = parameters_.number("POINT:LONG_FRAMES");
    if (many && *many >= 1 && *many < 1e9) return static_cast<size_t>(*many);
    const int last = bytes_.uint16(word(5));
    if (last < first_frame_)
      bytes_.fail(word(5), "the last frame, " + std::to_string(last) + ", is before the first, " +
                               std::to_string(first_frame_) + "; the file is damaged");
    return static_cast<size_t>(last - first_frame_) + 1;
  }

  std::optional<size_t> long_count(const std::string& name) const {
    const std::optional<int> low = parameters_.unsigned_integer(name, 0), high = parameters_.unsigned_integer(name, 1);
    if (!low || !high) return std::nullopt;
    return static_cast<size_t>(*low) + (static_cast<size_t>(*high) << 16);
  }

  // Labels of points that are angles, forces and so on, computed by the program that wrote the file.
  std::set<std::string> computed() const {
    std::set<std::string> names;
    for (const char* kind : {"ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS", "REACTIONS"})
      for (const std::string& name : parameters_.texts(std::string("POINT:") + kind)) names.insert(name);
    return names;
  }

  void read_names() {
    std::vector<std::string> labels;
    for (const char* part : {"LABELS", "LABELS2", "LABELS3", "LABELS4"})
      for (std::string& label : parameters_.texts(std::string("POINT:") + part)) labels.push_back(std::move(label));
    const std::set<std::string> others = computed();
    size_t skipped = 0;
    for (size_t i = 0; i < points_; ++i) {
      const std::string label = i < labels.size() ? labels[i] : "";
      if (!label.empty() && others.contains(label)) {
        ++skipped;
        continue;
      }
      columns_.push_back(i);
      recording_.names.push_back(label.empty() ? "point " + std::to_string(i + 1) : label);
    }
    if (columns_.empty())
      bytes_.fail(word(2),
                  "the file has no positions, only computed quantities; export the trajectories of the markers");
    if (skipped > 0)
      recording_.notes.push_back(recording_.file + ": " + std::to_string(skipped) +
                                 " points are angles, forces or other computed quantities; they were skipped");
  }

  void read_unit() {
    const std::vector<std::string> units = parameters_.texts("POINT:UNITS");
    if (units.empty()) return;
    recording_.unit = length_unit(units[0]);
    if (!recording_.unit)
      recording_.notes.push_back(recording_.file + ": POINT:UNITS = '" + units[0] +
                                 "' is no known unit (mm, cm, m, um, in); the unit of length of the data set applies");
  }

  void read_rate() {
    rate_ = parameters_.number("POINT:RATE").value_or(bytes_.real(word(11)));
    recording_.has_times = std::isfinite(rate_) && rate_ > 0;
    if (!recording_.has_times)
      recording_.notes.push_back(recording_.file + ": the rate of frames is " + six_digits(rate_) +
                                 " Hz; frames have no times");
  }

  void read_frames() {
    for (size_t f = 0; f < frame_count_; ++f) {
      const size_t at = start_ + f * frame_bytes_;
      RecordedFrame frame{first_frame_ + static_cast<int>(f),
                          recording_.has_times ? static_cast<double>(f) / rate_ : 0,
                          recording_.file + ": byte " + std::to_string(at),
                          {}};
      frame.positions.reserve(columns_.size());
      for (const size_t column : columns_)
        frame.positions.push_back(is_real() ? real_point(at + 16 * column) : integer_point(at + 8 * column));
      recording_.frames.push_back(std::move(frame));
    }
  }

  Vec3d integer_point(size_t at) const {
    if (bytes_.int16(at + 6) < 0) return {{kUnseen, kUnseen, kUnseen}};
    return {{scale_ * bytes_.int16(at), scale_ * bytes_.int16(at + 2), scale_ * bytes_.int16(at + 4)}};
  }

  Vec3d real_point(size_t at) const {
    const Vec3d p = {{bytes_.real(at), bytes_.real(at + 4), bytes_.real(at + 8)}};
    const double residual = bytes_.real(at + 12);
    return is_seen(p) && !(residual < 0) ? p : Vec3d{{kUnseen, kUnseen, kUnseen}};
  }

  C3dBytes bytes_;
  C3dParameters parameters_;
  Recording recording_;
  size_t points_ = 0, frame_count_ = 0, frame_bytes_ = 0, start_ = 0;
  int first_frame_ = 1;
  double scale_ = 1, rate_ = 0;
  std::vector<size_t> columns_;  // points that are positions
};

}  // namespace

Recording parse_c3d(const std::string& file, std::string_view contents) { return C3dReader(file, contents).read(); }

}  // namespace aspic
