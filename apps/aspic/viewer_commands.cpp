// Commands that need the viewer.
#include "aspic/commands.h"

namespace aspic::cli {

void add_viewer_commands(CLI::App& app, Action& action) {
  add_view(app, action);
  add_report(app, action);
  add_render(app, action);
}

}  // namespace aspic::cli
