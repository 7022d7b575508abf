#include "aspic/program.h"

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

#include "aspic/interrupt.h"
#include "aspic/streams.h"
#include "base/error.h"
#include "base/printable.h"
#include "io/external_program.h"
#include "io/text_scanner.h"
#include "scene/overrides.h"

namespace aspic::cli {
namespace {

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

int run_program(int argc, char** argv, const CommandList& add_commands) {
  CLI::App app("Aspic animates soft bodies; every time step is one minimization.", "aspic");
  app.footer(kFooter);
  app.require_subcommand(1);
  app.set_version_flag("--version", version_text, "Print version and build information");
  app.get_formatter()->column_width(32);

  Action action;
  add_commands(app, action);
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
int run_guarded(int argc, char** argv, const CommandList& add_commands) {
  try {
    return run_program(argc, argv, add_commands);
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

int main_program(int argc, char** argv, const CommandList& add_commands) {
  guard_standard_streams();
  const int code = run_guarded(argc, argv, add_commands);
  const std::string lost = lost_output();  // lost tables or JSON are an error
  if (lost.empty()) return code;
  if (interrupt_signal() == SIGPIPE) return exit_signal + SIGPIPE;  // the reader closed the pipe deliberately
  fmt::print(stderr, "error: standard output: cannot be written: {}; free some space or choose another disk\n", lost);
  return code == exit_done || code == exit_unconverged ? exit_bad_input : code;
}

}  // namespace aspic::cli
