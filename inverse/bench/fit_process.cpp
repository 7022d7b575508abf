#include "bench/fit_process.h"

#include <fmt/format.h>

#include <numeric>

#include "io/atomic_file.h"
#include "io/external_program.h"
#include "mesh/tet_shape.h"
#include "model/quantity.h"

namespace aspic::bench {
namespace {

namespace fs = std::filesystem;

const char* const kMessages = "fit_errors.txt";

double mean_over_volume(const TetMesh& mesh, const std::vector<double>& values) {
  double sum = 0, volumes = 0;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const double v = volume(mesh, t);
    sum += v * values[t], volumes += v;
  }
  return sum / volumes;
}

Launch launch(const fs::path& data, const FittedMaterial& truth) {
  const fs::path program = find_program("aspic", {program_folder()}, "the bench runs it to fit a material");
  Launch fit{.command = {program.string(), "fit", data.string(), "-o", (data / "material.vtu").string(), "--model",
                         truth.model, "--verbose"},
             .output = data / "fit.txt",
             .messages = data / kMessages,
             .lifetime = Lifetime::own_group};
  for (const std::string& quantity : quantities_of(truth.model)) {
    if (is_stiffness(quantity)) continue;
    fit.command.emplace_back("--known");
    fit.command.push_back(fmt::format("{}={}", quantity, mean_over_volume(truth.mesh, *truth.find(quantity))));
  }
  return fit;
}

}  // namespace

FitProcess::FitProcess(const fs::path& data, const FittedMaterial& truth)
    : folder_(data),
      report_(data / "material.fit" / "report.html"),
      output_(data / "fit.txt"),
      process_(launch(data, truth)) {}

std::string FitProcess::last_line() {
  std::string text = read_file(output_);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

viewer::Json FitProcess::state() {
  const bool is_running = process_.is_running(), has_report = !is_running && fs::exists(report_);
  return {{"running", is_running},
          {"folder", folder_.string()},
          {"line", is_running   ? last_line()
                   : has_report ? "Done. The report has the values and their uncertainty."
                                : "The fit failed: " + process_.message()},
          {"has_report", has_report}};
}

}  // namespace aspic::bench
