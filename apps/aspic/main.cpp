// The program `aspic`: parses the command line, runs one command, and converts errors to messages and exit codes.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <new>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include "aspic/commands.h"
#include "aspic/interrupt.h"
#include "aspic/streams.h"
#include "base/error.h"
#include "base/printable.h"
#include "io/external_program.h"
#include "io/text_scanner.h"

namespace aspic::cli {
namespace {

bool is_assignment(const std::string& text) {
  const size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || text[0] == '-') return false;
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
           c == '.';
  };
  std::error_code error;
  return std::all_of(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(equals), fits) &&
         !std::filesystem::exists(text, error);
}

// Inserts --set before each further KEY=VALUE: `--set A=1 B=2` becomes `--set A=1 --set B=2`. The name of an existing
// file is no assignment.
std::vector<std::string> spread_assignments(const std::vector<std::string>& arguments) {
  std::vector<std::string> result;
  bool follows_one = false;  // follows --set KEY=VALUE
  for (size_t i = 0; i < arguments.size(); ++i) {
    if (follows_one && is_assignment(arguments[i])) result.emplace_back("--set");
    const bool is_value = i > 0 && arguments[i - 1] == "--set";
    follows_one = is_value || arguments[i].starts_with("--set=") || (follows_one && is_assignment(arguments[i]));
    result.push_back(arguments[i]);
  }
  return result;
}

// Replaces `help COMMAND` by `COMMAND --help`.
std::vector<std::string> without_help_command(std::vector<std::string> arguments) {
  if (arguments.empty() || arguments[0] != "help") return arguments;
  arguments.erase(arguments.begin());
  arguments.push_back("--help");
  return arguments;
}

constexpr char kFooter[] = R"(
Examples:
  aspic run bunny.obj                       a closed surface or tet mesh, with defaults
  aspic run scenes/bunny.toml --steps 50    the first 50 steps of a scene
  aspic view scenes/bunny.toml              the same in the browser, interactively
  aspic check bunny.mesh                    errors of a mesh
  aspic materials                           materials and their formulas
'aspic COMMAND --help' describes a command.

Exit codes: 0 done, 1 internal error, 2 bad input, 3 not converged, a wrong derivative, a failed check,
4 time limit, 130 interrupted by Ctrl-C, 143 by kill, 141 if the reader of a pipe ended. Standard output that
cannot be written is bad input, too, but a run continues to its end. Messages that standard error cannot accept
are discarded.)";

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands(nullptr)) names.push_back(command->get_name());
  return names;
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

// Returns a correction for the command line; empty if no name is close.
std::string hint(const CLI::App& app, const std::vector<std::string>& arguments) {
  const std::vector<std::string> commands = command_names(app);
  const std::string& first = arguments.front();
  const bool is_command = std::find(commands.begin(), commands.end(), first) != commands.end();
  if (!is_command && first[0] != '-') {
    if (std::filesystem::exists(first)) return fmt::format("'{0}' is a file: aspic run {0}", first);
    return fmt::format("unknown command '{}'{}", first, suggestion(first, commands));
  }
  const CLI::App& command = is_command ? *app.get_subcommand(first) : app;
  const std::vector<std::string> known = option_names(command);
  for (const std::string& argument : arguments) {
    const std::string name = argument.substr(0, argument.find('='));
    if (name.starts_with("--") && std::find(known.begin(), known.end(), name) == known.end()) {
      return fmt::format("unknown option '{}'{}", name, suggestion(name, known));
    }
  }
  return "";
}

// Comparisons with NaN are false, so range checks would accept it.
void require_finite_numbers(CLI::App& app) {
  const auto complaint = [](const std::string& text) -> std::string {
    return parse_number(text) ? "" : "'" + text + "' is not a finite number";
  };
  for (CLI::App* command : app.get_subcommands(nullptr))
    for (CLI::Option* option : command->get_options())
      if (option->get_type_name().starts_with("FLOAT")) option->check(complaint);
}

int report_parse_error(const CLI::App& app, const CLI::ParseError& error, const std::vector<std::string>& arguments) {
  if (error.get_exit_code() == 0) {  // --help, --version
    std::ostringstream text;
    app.exit(error, text);
    fmt::print("{}", text.str());
    return exit_done;
  }
  const std::string meant = arguments.empty() ? "" : hint(app, arguments);
  fmt::print(stderr, "error: {}\n", printable(meant.empty() ? error.what() : meant));
  const auto chosen = app.get_subcommands();
  fmt::print(stderr, "'aspic {}--help' lists the options.\n", chosen.empty() ? "" : chosen[0]->get_name() + " ");
  return exit_bad_input;
}

int run_program(int argc, char** argv) {
  CLI::App app("Aspic animates soft bodies; every time step is one minimization.", "aspic");
  app.footer(kFooter);
  app.require_subcommand(1);
  app.set_version_flag("--version", version_text, "Print version and build information");
  app.get_formatter()->column_width(32);

  Action action;
  add_run(app, action);
  add_check(app, action);
  add_mesh(app, action);
  add_convert(app, action);
  add_fit(app, action);
  add_fit_jobs(app, action);
  add_compare(app, action);
  add_materials(app, action);
  add_fit_curves(app, action);
  add_fit_motion(app, action);
  add_closed_loop(app, action);
  add_minimize(app, action);
  add_capture(app, action);
  add_modes(app, action);
  add_lecture(app, action);
  add_sweep(app, action);
  add_schema(app, action);
  add_verify(app, action);
  add_viewer_commands(app, action);
  add_completion(app, action);
  require_finite_numbers(app);
  if (argc == 1) {
    fmt::print("{}", app.help());
    return exit_bad_input;
  }
  try {
    std::vector<std::string> spread = spread_assignments(without_help_command({argv + 1, argv + argc}));
    std::reverse(spread.begin(), spread.end());  // the order that CLI11 expects
    app.parse(std::move(spread));
  } catch (const CLI::ParseError& error) {
    return report_parse_error(app, error, {argv + 1, argv + argc});
  }
  return action();
}

// Returns the exit code. Throws nothing.
int run_guarded(int argc, char** argv) {
  try {
    return run_program(argc, argv);
  } catch (const TimeLimitPassed& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return exit_time_limit;
  } catch (const InvalidInput& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return exit_bad_input;
  } catch (const std::filesystem::filesystem_error& error) {
    fmt::print(stderr, "error: {}: {}; check the name, the folder and its permissions\n",
               printable(error.path1().string()), error.code().message());
    return exit_bad_input;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "error: out of memory; use a smaller mesh or fewer --threads, or raise the limit (ulimit -v)\n");
  } catch (const std::system_error& error) {
    fmt::print(stderr, "error: the system refused: {}; check its limits (ulimit -a) and the free memory\n",
               printable(error.what()));
  } catch (const std::exception& error) {
    fmt::print(stderr, "internal error: {}\nThis should not happen; please report it with the command and its input.\n",
               printable(error.what()));
  }
  return exit_internal_error;
}

}  // namespace
}  // namespace aspic::cli

int main(int argc, char** argv) {
  using namespace aspic::cli;
  guard_standard_streams();
  const int code = run_guarded(argc, argv);
  const std::string lost = lost_output();  // lost tables or JSON are an error
  if (lost.empty()) return code;
  if (interrupt_signal() == SIGPIPE) return exit_signal + SIGPIPE;  // the reader closed the pipe deliberately
  fmt::print(stderr, "error: standard output: cannot be written: {}; free some space or choose another disk\n", lost);
  return code == exit_done || code == exit_unconverged ? exit_bad_input : code;
}
