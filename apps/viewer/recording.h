// Packs a run directory into one text for the viewer's page: the messages of a live session, the surfaces and their
// motion. web/src/recording.ts reads it.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "scene/scene.h"

namespace aspic::viewer {

struct RecordingOptions {
  size_t max_bytes = 10'000'000;  // maximum size of the text; omits frames evenly to fit
};

struct RecordedRun {
  std::string text;  // gzip in base64; of a report: HTML
  int frames_of_run = 0, frames = 0;
  std::string note;  // summary of omitted data; empty: none
};

// `scene`: the scene of the run. Memory is bounded for runs of any length. Equal results give equal texts, since wall
// times are omitted. Throws InvalidInput for a directory without a run, for damaged files, and if two frames do not
// fit.
RecordedRun record(const std::filesystem::path& run, const Scene& scene, const RecordingOptions& options = {});

// Returns one self-contained HTML file: the viewer's page with the recording. Throws InvalidInput like record().
RecordedRun make_report(const std::filesystem::path& run, const Scene& scene, const RecordingOptions& options = {});

// Returns the page with a recording: the text of record(), or of another pack of that format.
std::string page_with_recording(std::string_view text);

}  // namespace aspic::viewer
