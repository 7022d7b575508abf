// The report that a run leaves in its directory.
#pragma once
#include <cstdio>
#include <filesystem>

#include "scene/scene.h"

namespace aspic::cli {

// Writes report.html into the directory of the run when the scene asks for it, and tells so on `stream` (null: does
// not). Why it could not be written is told on stderr: whatever goes wrong here, the run is what it was.
void write_run_report(const std::filesystem::path& run, const Scene& scene, std::FILE* stream);

}  // namespace aspic::cli
