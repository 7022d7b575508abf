// Reads the tables of a run directory back into step reports.
#pragma once
#include <string>
#include <vector>

#include "results/run_directory_layout.h"
#include "viewer/step_rows.h"

namespace aspic::viewer {

struct RunTables {
  std::vector<std::string> potentials;  // names of the terms of V, as in StepReport::potential
  std::vector<StepRow> steps;           // steps 1, 2, ... without wall times and explanations; trials only with a trace
};

// Reads steps 1 to `last_step`. Uses the latest trace of each step of a resumed run.
// Throws InvalidInput with file and line.
RunTables read_run_tables(const RunLayout& layout, int last_step);

}  // namespace aspic::viewer
