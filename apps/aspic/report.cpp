// `aspic report`: writes a run as one self-contained HTML file, as runs do at their end.
#include "viewer/recording.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <exception>
#include <filesystem>

#include "aspic/commands.h"
#include "aspic/run_report.h"
#include "base/error.h"
#include "io/atomic_file.h"
#include "results/run_directory.h"
#include "results/run_directory_layout.h"

namespace aspic::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kMegabyte = 1e6;

struct ReportArguments {
  fs::path run, out;
  double max_size = viewer::RecordingOptions().max_bytes / kMegabyte;
};

// "out/bunny/report.html: 201 frames, 2.2 MB"
std::string written(const fs::path& file, const viewer::RecordedRun& report) {
  return fmt::format("{}: {} frames, {:.1f} MB", file.string(), report.frames,
                     static_cast<double>(report.text.size()) / kMegabyte);
}

int report(const ReportArguments& arguments) {
  if (!fs::is_directory(arguments.run))
    throw InvalidInput(
        fmt::format("{}: is not the directory of a run; aspic run writes out/NAME by default", arguments.run.string()));
  if (!std::isfinite(arguments.max_size)) throw InvalidInput("--max-size: give a finite number of megabytes");
  const Scene scene = load_scene(scene_of_run(arguments.run));
  const auto max_bytes = static_cast<size_t>(arguments.max_size * kMegabyte);
  const viewer::RecordedRun report = viewer::make_report(arguments.run, scene, {.max_bytes = max_bytes});
  const fs::path file = arguments.out.empty() ? RunLayout(arguments.run).report() : arguments.out;
  write_file(file, report.text);
  if (!report.note.empty()) fmt::print("note: {}\n", report.note);
  fmt::print("{}; open it in a browser\n", written(file, report));
  return exit_done;
}

}  // namespace

void write_run_report(const fs::path& run, const Scene& scene, std::FILE* stream) {
  if (!scene.output.report) return;
  try {
    const viewer::RecordedRun report = viewer::make_report(run, scene);
    const fs::path file = RunLayout(run).report();
    write_file(file, report.text);
    if (!stream) return;
    fmt::print(stream, "           browser: open {}\n", written(file, report));
    if (!report.note.empty()) fmt::print(stream, "           {}\n", report.note);
  } catch (const std::exception& error) {
    fmt::print(stderr, "warning: no report.html: {}\n", error.what());
  }
}

void add_report(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<ReportArguments>();
  CLI::App* command = app.add_subcommand("report", "Writes an HTML page of a run: playback, plots, certificate, scene");
  command->footer(R"(
Examples:
  aspic report out/bunny                      write out/bunny/report.html, as the run does at its end
  aspic report out/bunny -o bunny.html        another file; it needs no server and no network
  aspic report out/long --max-size 40         more frames of a long run

A run that is in progress or was killed is shown up to its latest checkpoint.)");
  command->add_option("RUN", arguments->run, "Directory of a run")->required();
  command->add_option("-o,--out", arguments->out, "File to write; RUN/report.html by default");
  command->add_option("--max-size", arguments->max_size, "Maximum size of the file [MB]; omits frames evenly")
      ->check(CLI::Range(1.0, 500.0));
  command->callback([arguments, &action] { action = [arguments] { return report(*arguments); }; });
}

}  // namespace aspic::cli
