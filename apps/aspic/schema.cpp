// `aspic schema`: prints the keys of scenes as JSON Schema.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "aspic/commands.h"
#include "scene/json_schema.h"

namespace aspic::cli {

void add_schema(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("schema", "Prints the JSON Schema of scenes, for completion in editors");
  command->footer(R"(
Examples:
  aspic schema > aspic.schema.json

If a scene begins with the line '#:schema ./aspic.schema.json', it is completed and checked in every
editor that uses Taplo, such as VS Code with the extension Even Better TOML.)");
  command->callback([&action] {
    action = [] {
      fmt::print("{}\n", scene_json_schema());
      return exit_done;
    };
  });
}

}  // namespace aspic::cli
