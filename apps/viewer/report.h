// A recorded run as one HTML file that needs nothing else: the viewer's page with the recording inside.
#pragma once
#include <filesystem>
#include <string>

#include "scene/scene.h"

namespace aspic::viewer {

struct ReportOptions {
  size_t max_bytes = 10'000'000;  // of the whole file
};

struct Report {
  std::string html;
  int frames_of_run = 0, frames = 0;
  std::string note;  // what was left out; empty: nothing
};

// `scene` is that of the run. Throws InvalidInput as record() does.
Report make_report(const std::filesystem::path& run, const Scene& scene, const ReportOptions& options = {});

}  // namespace aspic::viewer
