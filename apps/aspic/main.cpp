// The program `aspic`.
#include "aspic/program.h"

int main(int argc, char** argv) {
  using namespace aspic::cli;
  return main_program(argc, argv, [](CLI::App& app, Action& action) {
    add_run(app, action);
    add_gallery(app, action);
    add_check(app, action);
    add_convert(app, action);
    add_other_programs(app, action);
    add_compare(app, action);
    add_materials(app, action);
    add_minimize(app, action);
    add_modes(app, action);
    add_lecture(app, action);
    add_sweep(app, action);
    add_schema(app, action);
    add_verify(app, action);
    add_viewer_commands(app, action);
    add_completion(app, action);
  });
}
