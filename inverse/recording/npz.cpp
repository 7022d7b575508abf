#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "io/unzip.h"
#include "recording/formats.h"
#include "recording/npy.h"

namespace aspic {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

class NpzReader {
 public:
  NpzReader(const std::string& file, std::string_view contents)
      : bytes_(contents.size()),
        entries_(unzipped(file, contents, [](const std::string& name) { return is_needed(name); })) {
    recording_.file = file;
  }

  Recording read() {
    const std::optional<NpyArray> positions = array("positions");
    if (!positions) fail("has no array 'positions' of the shape (frames, points, 3)");
    const std::vector<size_t>& shape = positions->shape;
    if (shape.size() != 3 || (shape[2] != 3 && shape[2] != 2) || positions->numbers.empty())
      fail("positions has the shape " + text_of(shape) + "; it must be (frames, points, 3), or 2 for an image");
    recording_.is_planar = shape[2] == 2;
    read_names(shape[1]);
    read_times(shape[0]);
    read_unit();
    for (size_t f = 0; f < shape[0]; ++f) recording_.frames.push_back(frame(f, *positions));
    make_names_unique(recording_);
    check_recording(recording_, std::max(bytes_, positions->numbers.size()));
    return std::move(recording_);
  }

 private:
  static bool is_needed(const std::string& name) {
    return name == "positions.npy" || name == "names.npy" || name == "times.npy" || name == "unit.npy";
  }

  [[noreturn]] void fail(const std::string& message) const { throw InvalidInput(recording_.file + ": " + message); }

  static std::string text_of(const std::vector<size_t>& shape) {
    std::string text;
    for (const size_t n : shape) text += (text.empty() ? "(" : ", ") + std::to_string(n);
    return text.empty() ? "()" : text + ")";
  }

  std::optional<NpyArray> array(const std::string& name) const {
    for (const ZipEntry& entry : entries_)
      if (entry.name == name + ".npy") return parse_npy(recording_.file + ": " + entry.name, entry.bytes);
    return std::nullopt;
  }

  void read_names(size_t count) {
    const std::optional<NpyArray> names = array("names");
    if (names && names->texts.size() != count)
      fail("names has " + std::to_string(names->texts.size()) + " texts, but positions has " + std::to_string(count) +
           " points");
    for (size_t i = 0; i < count; ++i) recording_.names.push_back(names ? names->texts[i] : std::to_string(i));
  }

  void read_times(size_t count) {
    const std::optional<NpyArray> times = array("times");
    recording_.has_times = times.has_value();
    if (!times) return;
    if (times->numbers.size() != count)
      fail("times has " + std::to_string(times->numbers.size()) + " values, but positions has " +
           std::to_string(count) + " frames");
    for (const double t : times->numbers)
      if (!std::isfinite(t)) fail("times has a value that is not finite; give each frame its time");
    times_ = times->numbers;
  }

  void read_unit() {
    const std::optional<NpyArray> unit = array("unit");
    if (!unit) return;
    if (unit->texts.size() == 1) recording_.unit = length_unit(unit->texts[0]);
    if (!recording_.unit) fail("unit must be a text: m, cm, mm, um or in");
  }

  RecordedFrame frame(size_t f, const NpyArray& positions) const {
    const int number = static_cast<int>(f);
    RecordedFrame frame{
        number, times_.empty() ? 0 : times_[f], recording_.file + ": frame " + std::to_string(number), {}};
    const size_t points = recording_.names.size(), axes = positions.shape[2];
    for (size_t i = 0; i < points; ++i) {
      Vec3d p{};
      for (size_t axis = 0; axis < axes; ++axis)
        p[static_cast<int>(axis)] = positions.numbers[(f * points + i) * axes + axis];
      for (int axis = 0; axis < 3; ++axis)
        if (std::isinf(p[axis]))
          fail("positions[" + std::to_string(f) + ", " + std::to_string(i) + ", " + std::to_string(axis) + "] of '" +
               recording_.names[i] + "' is infinite; write NaN where a point was not seen");
      if (!is_seen(p)) p = {{kMissing, kMissing, kMissing}};
      frame.positions.push_back(p);
    }
    return frame;
  }

  size_t bytes_;
  std::vector<ZipEntry> entries_;
  std::vector<double> times_;
  Recording recording_;
};

}  // namespace

Recording parse_npz(const std::string& file, std::string_view contents) { return NpzReader(file, contents).read(); }

}  // namespace aspic
