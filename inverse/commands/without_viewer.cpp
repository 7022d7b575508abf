// The report of a fit in a build without the viewer.
#include <fmt/format.h>

#include "commands/fit_report.h"

namespace aspic::cli {

void write_fit_report(const std::filesystem::path&, const viewer::FitPageContent&, std::FILE* stream) {
  if (stream) fmt::print(stream, "no report.html: this aspic was built without its viewer\n");
}

}  // namespace aspic::cli
