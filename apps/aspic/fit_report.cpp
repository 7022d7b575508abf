#include "aspic/fit_report.h"

#include <fmt/format.h>

#include <exception>

#include "io/atomic_file.h"
#include "viewer/fit_page.h"

namespace aspic::cli {

void write_fit_report(const std::filesystem::path& file, const DataSet& data, const FitOutcome& outcome,
                      const std::vector<FitIteration>& history, std::FILE* stream) {
  try {
    const std::string html = viewer::fit_page(data, outcome, history);
    write_file(file, html);
    if (stream)
      fmt::print(stream, "report     {} ({:.1f} MB): open it in a browser\n", file.string(),
                 static_cast<double>(html.size()) / 1e6);
  } catch (const std::exception& error) {
    fmt::print(stderr, "warning: no report.html: {}\n", error.what());
  }
}

}  // namespace aspic::cli
