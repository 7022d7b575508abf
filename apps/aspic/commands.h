// Commands of the program. Each adds itself to the command line and, if selected, sets `action`.
#pragma once
#include <filesystem>
#include <functional>
#include <string>

namespace CLI {  // NOLINT(readability-identifier-naming): the name that CLI11 gave it
class App;
}

namespace aspic::cli {

enum ExitCode {
  exit_done = 0,
  exit_internal_error = 1,
  exit_bad_input = 2,
  exit_unconverged = 3,  // a step or minimization; check --derivatives: one is wrong; verify: a row fails
  exit_time_limit = 4,   // --time-limit reached; fit-jobs: jobs remain
  exit_signal = 128,     // plus the number of the signal: 130 after Ctrl-C, 143 after a plain kill
};

using Action = std::function<int()>;  // returns the exit code

void add_run(CLI::App& app, Action& action);
void add_gallery(CLI::App& app, Action& action);
void add_check(CLI::App& app, Action& action);
void add_other_programs(CLI::App& app, Action& action);  // mesh: aspic-mesh; fit, capture and others: aspic-fit
void add_convert(CLI::App& app, Action& action);
void add_compare(CLI::App& app, Action& action);
void add_materials(CLI::App& app, Action& action);
void add_minimize(CLI::App& app, Action& action);
void add_lecture(CLI::App& app, Action& action);
void add_modes(CLI::App& app, Action& action);
void add_schema(CLI::App& app, Action& action);
void add_sweep(CLI::App& app, Action& action);
void add_verify(CLI::App& app, Action& action);
void add_completion(CLI::App& app, Action& action);
void add_viewer_commands(CLI::App& app, Action& action);  // view, report, render
void add_view(CLI::App& app, Action& action);
void add_report(CLI::App& app, Action& action);
void add_render(CLI::App& app, Action& action);

// Begins, resumes, or does nothing, as `aspic run SCENE --out OUT --continue`; returns the exit code. Throws
// InvalidInput.
int run_scene(const std::filesystem::path& scene, const std::filesystem::path& out);

std::string version_text();

}  // namespace aspic::cli
