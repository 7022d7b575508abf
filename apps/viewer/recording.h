// A run directory as one text for the viewer's page: what a live session would have sent, its surfaces and their
// motion. web/src/recording.ts reads it.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace aspic::viewer {

struct RecordingOptions {
  size_t max_bytes = 10'000'000;  // of the text; frames are left out, evenly, until it fits
};

struct RecordedRun {
  std::string text;  // base64 of gzip: letters, digits, +, / and =
  int frames_of_run = 0, frames = 0;
  std::string note;  // what was left out; empty: nothing
};

// `scene` is that of the run. Holds a bounded number of frames in memory, however long the run is, and no wall times:
// the same results give the same text. Throws InvalidInput for a directory without a run, for damaged files, and when
// not even two frames fit.
RecordedRun record(const std::filesystem::path& run, const Scene& scene, const RecordingOptions& options = {});

}  // namespace aspic::viewer
