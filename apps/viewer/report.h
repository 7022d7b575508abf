// A recorded run as one self-contained HTML file: the viewer's page with the recording.
#pragma once
#include <filesystem>
#include <string>

#include "scene/scene.h"

namespace aspic::viewer {

struct ReportOptions {
  size_t max_bytes = 10'000'000;  // maximum size of the file
};

struct Report {
  std::string html;
  int frames_of_run = 0, frames = 0;
  std::string note;  // summary of omitted data; empty: none
};

// `scene`: the scene of the run. Throws InvalidInput like record().
Report make_report(const std::filesystem::path& run, const Scene& scene, const ReportOptions& options = {});

}  // namespace aspic::viewer
