// The commands of `aspic` for a first picture, without what the others must compile. ./run uses them until it has
// `aspic`.
#include "aspic/program.h"

int main(int argc, char** argv) {
  using namespace aspic::cli;
  return main_program(argc, argv, [](CLI::App& app, Action& action) {
    add_run(app, action);
    add_report(app, action);
  });
}
