// A measured motion of points, as read from a file of any supported format.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "math/small.h"

namespace aspic {

struct RecordedFrame {
  int number = 0;                // as the file counts frames
  double time = 0;               // [s], if the recording has times
  std::string where;             // place for messages: "walk.trc:12"
  std::vector<Vec3d> positions;  // one per point [unit of the recording]; NaN: not seen
};

struct Recording {
  std::string file;                     // name for messages
  std::vector<std::string> names;       // of the points; unique
  std::vector<RecordedFrame> frames;    // numbers and times ascend
  bool has_times = false;               // false: the file has none
  bool is_planar = false;               // two coordinates were measured; z is 0
  std::optional<double> unit;           // stated unit of length [m]
  std::vector<std::string> notes = {};  // assumptions of the reader
};

// Returns whether a name is that of a recording: a pattern with *, a known extension, or a table with the columns of a
// program for digital image correlation.
bool is_recording(const std::filesystem::path& path);

// Reads .trc, .c3d, .npz, .ply, .obj, or tables of image correlation. A * in the last part of the path selects a
// sequence of files, one per frame. Throws InvalidInput with file, line or byte, value and remedy.
Recording read_recording(const std::filesystem::path& path);

// Returns the index of the frame with this number. Throws InvalidInput with the known range.
int frame_numbered(const Recording& recording, int number);
// Returns the index of the frame closest to a time; throws InvalidInput if it is farther than half the frame interval.
int frame_at(const Recording& recording, double time);

bool is_seen(const Vec3d& position);  // false: NaN
// Returns the unit in m; empty if the text names none.
std::optional<double> length_unit(std::string_view text);

}  // namespace aspic
