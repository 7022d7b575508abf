// The report of a run in a build without the viewer.
#include <fmt/format.h>

#include "aspic/run_report.h"

namespace aspic::cli {

void write_run_report(const std::filesystem::path&, const Scene& scene, std::FILE* stream) {
  if (scene.output.report && stream) fmt::print(stream, "no report.html: this aspic was built without its viewer\n");
}

}  // namespace aspic::cli
