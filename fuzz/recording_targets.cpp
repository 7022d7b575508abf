// Readers of recordings of other programs.
#include "io/unzip.h"
#include "recording/formats.h"
#include "several_files.h"
#include "targets.h"

namespace aspic::fuzz {
namespace {

void require_recording(const Recording& recording) {
  require(!recording.names.empty() && !recording.frames.empty(), "a recording has points and frames");
  fuzz::require_printable(recording.names);
  fuzz::require_printable(recording.notes);
  for (const RecordedFrame& frame : recording.frames) {
    require(frame.positions.size() == recording.names.size(), "a frame has a position per point");
    require(frame_numbered(recording, frame.number) >= 0, "frames are found by their number");
    if (recording.has_times) require(frame_at(recording, frame.time) >= 0, "frames are found by their time");
  }
}

}  // namespace

void trc(std::string_view bytes) { require_recording(parse_trc("walk.trc", bytes)); }
void c3d(std::string_view bytes) { require_recording(parse_c3d("walk.c3d", bytes)); }
void npz(std::string_view bytes) { require_recording(parse_npz("walk.npz", bytes)); }

void dic_tables(std::string_view bytes) {
  const auto folder = folder_of_process();
  const Files files(folder, bytes, {"dic_0.csv", "dic_1.csv"});
  require_recording(read_recording(folder / "dic_*.csv"));
}

void surface_sequence(std::string_view bytes) {
  const auto folder = folder_of_process();
  const Files files(folder, bytes, {"scan_0.ply", "scan_1.obj"});
  require_recording(read_recording(folder / "scan_*"));
}

}  // namespace aspic::fuzz
