// Report of a run in its directory.
#pragma once
#include <cstdio>
#include <filesystem>

#include "scene/scene.h"

namespace aspic::cli {

// Writes report.html into the directory of the run if the scene enables it, and prints its path to `stream` (null:
// nothing). Failures are reported on stderr and do not affect the run.
void write_run_report(const std::filesystem::path& run, const Scene& scene, std::FILE* stream);

}  // namespace aspic::cli
