// Replacements of the viewer's functions in a build without it. The commands throw InvalidInput with the remedy; runs
// print that there is no report.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "aspic/commands.h"
#include "aspic/mesh_picture.h"
#include "aspic/run_report.h"
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

void write_run_report(const std::filesystem::path&, const Scene& scene, std::FILE* stream) {
  if (scene.output.report && stream) fmt::print(stream, "no report.html: this aspic was built without its viewer\n");
}

bool draw(const std::vector<MeshDrawing>&, const StopToken&) {
  throw InvalidInput("pictures of meshes need the viewer, and this aspic was built without it (ASPIC_VIEWER=OFF)");
}

}  // namespace aspic::cli
