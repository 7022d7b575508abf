// Replacements of the viewer's functions in a build without it. The commands throw InvalidInput with the remedy.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "aspic/commands.h"
#include "aspic/mesh_picture.h"
#include "base/error.h"

namespace aspic::cli {

void add_viewer_commands(CLI::App& app, Action& action) {
  for (const char* name : {"view", "report", "render"}) {
    CLI::App* command = app.add_subcommand(name, "")->group("")->allow_extras();  // hidden in the list of commands
    command->callback([name, &action] {
      action = [name]() -> int {
        throw InvalidInput(fmt::format(
            "aspic {}: this aspic was built without its viewer; build it with nodejs, npm and libboost-dev installed "
            "and cmake -DASPIC_VIEWER=ON",
            name));
      };
    });
  }
}

bool draw(const std::vector<MeshDrawing>&, const StopToken&) {
  throw InvalidInput("pictures of meshes need the viewer, and this aspic was built without it (ASPIC_VIEWER=OFF)");
}

}  // namespace aspic::cli
