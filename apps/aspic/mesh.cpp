// `aspic mesh`: replaces itself by the separate program aspic-mesh, which is not linked because of CGAL's GPL.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "aspic/commands.h"
#include "base/error.h"

namespace aspic::cli {
namespace {

std::filesystem::path mesher() {
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  const auto beside = self.parent_path() / "aspic-mesh";
  return !error && std::filesystem::exists(beside) ? beside : "aspic-mesh";
}

int become_mesher(std::vector<std::string> arguments) {
  std::string program = mesher().string();
  std::vector<char*> argv = {program.data()};
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  execvp(program.c_str(), argv.data());
  throw InvalidInput(std::string("the program aspic-mesh cannot be started: ") + std::strerror(errno) +
                     "; build it (ASPIC_MESHER=ON, needs libcgal-dev) or put it on the PATH");
}

}  // namespace

void add_mesh(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("mesh", "Fills a closed surface with tets: SURFACE -o TETS (aspic-mesh)");
  command->set_help_flag();  // passes all options to aspic-mesh, including --help
  command->prefix_command();
  command->callback([command, &action] {
    std::vector<std::string> arguments = command->remaining();
    if (arguments.empty()) arguments = {"--help"};
    action = [arguments] { return become_mesher(arguments); };
  });
}

}  // namespace aspic::cli
