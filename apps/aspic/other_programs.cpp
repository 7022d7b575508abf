#include "aspic/other_programs.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "aspic/commands.h"
#include "base/error.h"
#include "io/external_program.h"

namespace aspic::cli {
namespace {

constexpr char kMesher[] = "aspic-mesh", kFit[] = "aspic-fit";

struct OtherCommand {
  const char *name, *program, *text;
};
constexpr OtherCommand kCommands[] = {
    {"mesh", kMesher, "Fills a closed surface with tets: SURFACE -o TETS (aspic-mesh)"},
    {"fit", kFit, "Fits a material to measurements, with its uncertainty"},
    {"fit-jobs", kFit, "Lists the independent fits of a fit for xargs, GNU parallel or Slurm"},
    {"fit-motion", kFit, "Fits material, damping and initial velocity to a measured motion"},
    {"capture", kFit, "Makes synthetic measurements of a body, for fits with known truth"},
};

std::string beside(const std::string& program) {
  const std::filesystem::path path = program_folder() / program;
  return is_program(path) ? path.string() : "";
}

std::string remedy_for(const std::string& program) {
  return std::string("in Aspic's sources `./run ") + (program == kMesher ? "mesh" : "fit") +
         "` builds it; or put it on the PATH";
}

}  // namespace

void become(const std::string& program, std::vector<std::string> arguments) {
  std::string path = beside(program);
  if (path.empty()) path = program;
  std::vector<char*> argv = {path.data()};
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  execvp(path.c_str(), argv.data());
  throw InvalidInput("the program " + program + " cannot be started: " + std::strerror(errno) + "; " +
                     remedy_for(program));
}

std::string program_with(const std::string& command) {
  for (const OtherCommand& other : kCommands)
    if (command == other.name && other.program == kFit) return beside(other.program);
  return "";
}

void add_other_programs(CLI::App& app, Action& action) {
  for (const OtherCommand& other : kCommands) {
    CLI::App* command = app.add_subcommand(other.name, other.text);
    command->set_help_flag();  // passes all options on, including --help
    command->prefix_command();
    command->callback([command, &other, &action] {
      std::vector<std::string> arguments = command->remaining();
      if (arguments.empty()) arguments = {"--help"};
      if (other.program == kFit) arguments.insert(arguments.begin(), other.name);
      action = [&other, arguments]() -> int { become(other.program, arguments); };
    });
  }
}

}  // namespace aspic::cli
