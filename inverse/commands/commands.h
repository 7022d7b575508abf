// Commands of the program aspic-fit, which `aspic` runs.
#pragma once
#include "aspic/commands.h"

namespace aspic::cli {

void add_fit(CLI::App& app, Action& action);
void add_fit_jobs(CLI::App& app, Action& action);
void add_fit_motion(CLI::App& app, Action& action);
void add_capture(CLI::App& app, Action& action);
void add_check_data(CLI::App& app, Action& action);

}  // namespace aspic::cli
