#include "commands/fit_report.h"

#include <fmt/format.h>

#include <exception>

#include "io/atomic_file.h"

namespace aspic::cli {

void write_fit_report(const std::filesystem::path& file, const viewer::FitPageContent& content, std::FILE* stream) {
  try {
    const std::string html = viewer::fit_page(content);
    write_file(file, html);
    if (stream)
      fmt::print(stream, "report     {} ({:.1f} MB): open it in a browser\n", file.string(),
                 static_cast<double>(html.size()) / 1e6);
  } catch (const std::exception& error) {
    fmt::print(stderr, "warning: no report.html: {}\n", error.what());
  }
}

}  // namespace aspic::cli
