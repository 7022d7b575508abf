#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/number_chars.h"
#include "base/printable.h"
#include "recording/formats.h"

namespace aspic {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::string_view trimmed_cell(std::string_view cell) {
  const size_t first = cell.find_first_not_of(" \r");
  return first == std::string_view::npos ? std::string_view()
                                         : cell.substr(first, cell.find_last_not_of(" \r") + 1 - first);
}

// Cells of a line. Tabs separate cells, which may be blank; without tabs, blanks do.
std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  const bool has_tabs = line.find('\t') != std::string_view::npos;
  for (size_t begin = 0; begin <= line.size();) {
    const size_t end = std::min(line.find(has_tabs ? '\t' : ' ', begin), line.size());
    const std::string_view cell = trimmed_cell(line.substr(begin, end - begin));
    if (has_tabs || !cell.empty()) cells.push_back(cell);
    begin = end + 1;
  }
  return cells;
}

class TrcReader {
 public:
  TrcReader(const std::string& file, std::string_view contents) : contents_(contents) { recording_.file = file; }

  Recording read() {
    if (!next() || !line_.starts_with("PathFileType"))
      fail("does not begin with 'PathFileType'; export a TRC file of marker positions");
    read_head();
    read_names();
    while (next())
      if (!trimmed_cell(line_).empty() && !is_axes()) read_frame();
    finish();
    return std::move(recording_);
  }

 private:
  bool next() {
    if (position_ >= contents_.size()) return false;
    const size_t end = std::min(contents_.find('\n', position_), contents_.size());
    line_ = contents_.substr(position_, end - position_);
    has_break_ = end < contents_.size();
    position_ = end + 1;
    ++number_;
    return true;
  }

  std::string where() const { return recording_.file + ":" + std::to_string(number_); }
  [[noreturn]] void fail(const std::string& message) const { throw InvalidInput(where() + ": " + message); }

  void read_head() {
    if (!next()) fail("ends before the line with DataRate and NumMarkers; get a complete copy");
    const std::vector<std::string_view> keys = cells_of(line_);
    if (!next()) fail("ends before the values of DataRate and NumMarkers; get a complete copy");
    const std::vector<std::string_view> values = cells_of(line_);
    for (size_t i = 0; i < std::min(keys.size(), values.size()); ++i) {
      if (keys[i] == "NumMarkers") stated_points_ = integer(values[i], "NumMarkers");
      if (keys[i] == "NumFrames") stated_frames_ = integer(values[i], "NumFrames");
      if (keys[i] == "Units") read_unit(values[i]);
    }
    if (stated_points_ < 0) fail("has no value below NumMarkers; the third line holds the values of the second");
  }

  void read_unit(std::string_view text) {
    recording_.unit = length_unit(text);
    if (!recording_.unit)
      recording_.notes.push_back(where() + ": Units = " + shown(text) +
                                 " is no known unit (mm, cm, m, um, in); the unit of length of the data set applies");
  }

  void read_names() {
    if (!next()) fail("ends before the names of the markers; get a complete copy");
    const std::vector<std::string_view> cells = cells_of(line_);
    for (size_t i = 2; i < cells.size(); ++i)
      if (!cells[i].empty()) recording_.names.push_back(printable(cells[i]));
    if (static_cast<int64_t>(recording_.names.size()) != stated_points_)
      fail("names " + std::to_string(recording_.names.size()) + " markers, but NumMarkers is " +
           std::to_string(stated_points_) + "; the file is cut short or was edited");
  }

  bool is_axes() const {  // "X1 Y1 Z1 X2 ...", below the names
    const std::string_view first = trimmed_cell(line_.substr(std::min(line_.find_first_not_of("\t "), line_.size())));
    return recording_.frames.empty() && !first.empty() && (first[0] == 'X' || first[0] == 'x');
  }

  void read_frame() {
    const std::vector<std::string_view> cells = cells_of(line_);
    const size_t points = recording_.names.size(), whole = 2 + 3 * points;
    if (cells.size() < whole && (!has_break_ || line_.find('\t') == std::string_view::npos))
      fail("has " + std::to_string(cells.size()) + " cells; a frame of " + std::to_string(points) + " markers has " +
           std::to_string(whole) + " (is the file cut short?)");
    for (size_t i = whole; i < cells.size(); ++i)
      if (!cells[i].empty())
        fail(shown(cells[i]) + " follows the last marker; the line names fewer markers than it has");
    check_density(recording_.frames.size() + 1, points, contents_.size(), where());
    RecordedFrame frame{static_cast<int>(integer(cells[0], "Frame#")), 0, where(), std::vector<Vec3d>(points)};
    frame.time = number(cells.size() > 1 ? cells[1] : "");
    if (!std::isfinite(frame.time)) fail("Time is blank or not finite; export the file again");
    for (size_t m = 0; m < points; ++m)
      for (int axis = 0; axis < 3; ++axis) {
        const size_t i = 2 + 3 * m + axis;
        frame.positions[m][axis] = i < cells.size() ? number(cells[i]) : kNan;
      }
    hide_origin(frame.positions);
    recording_.frames.push_back(std::move(frame));
  }

  // Several programs write 0 0 0 for a marker that they did not see.
  void hide_origin(std::vector<Vec3d>& positions) {
    for (Vec3d& p : positions)
      if (p[0] == 0 && p[1] == 0 && p[2] == 0) p = {{kNan, kNan, kNan}}, ++at_origin_;
  }

  int64_t integer(std::string_view cell, const char* what) const {
    int value = 0;
    const auto [end, error] = from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error != std::errc() || end != cell.data() + cell.size() || value < 0)
      fail(std::string(what) + " = " + shown(cell) + " is not a whole number");
    return value;
  }

  double number(std::string_view cell) const {
    if (cell.empty()) return kNan;
    if (cell[0] == '+') cell.remove_prefix(1);
    double value = 0;
    const auto [end, error] = from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error != std::errc() || end != cell.data() + cell.size())
      fail(shown(cell) + " is not a number; leave the cell blank if the marker was not seen");
    return std::isfinite(value) ? value : kNan;
  }

  void finish() {
    recording_.has_times = true;
    const auto read = static_cast<int64_t>(recording_.frames.size());
    if (stated_frames_ >= 0 && stated_frames_ != read)
      recording_.notes.push_back(recording_.file + ": NumFrames is " + std::to_string(stated_frames_) +
                                 ", but the file has " + std::to_string(read) + " frames; these are used");
    if (at_origin_ > 0)
      recording_.notes.push_back(recording_.file + ": " + std::to_string(at_origin_) +
                                 " positions are exactly 0 0 0; these markers count as not seen");
    make_names_unique(recording_);
    check_recording(recording_, contents_.size());
  }

  std::string_view contents_, line_;
  size_t position_ = 0;
  int number_ = 0;
  bool has_break_ = false;
  int64_t stated_points_ = -1, stated_frames_ = -1, at_origin_ = 0;
  Recording recording_;
};

}  // namespace

Recording parse_trc(const std::string& file, std::string_view contents) { return TrcReader(file, contents).read(); }

}  // namespace aspic
