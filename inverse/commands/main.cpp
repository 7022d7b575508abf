// The program `aspic-fit`: the commands of inverse problems. `aspic fit` and its siblings run it.
#include "aspic/program.h"
#include "commands/commands.h"

int main(int argc, char** argv) {
  using namespace aspic::cli;
  return main_program(argc, argv, [](CLI::App& app, Action& action) {
    add_fit(app, action);
    add_fit_jobs(app, action);
    add_fit_motion(app, action);
    add_capture(app, action);
    add_check_data(app, action);
    add_completion(app, action);
  });
}
