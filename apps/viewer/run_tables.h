// The tables of a run directory as what they were written from.
#pragma once
#include <string>
#include <vector>

#include "scene/run_directory_layout.h"
#include "viewer/step_rows.h"

namespace aspic::viewer {

struct RunTables {
  std::vector<std::string> potentials;  // names of the terms of V, as in StepReport::potential
  std::vector<StepRow> steps;           // 1, 2, ...; no wall times, no explanations, no trials without a trace
};

// Steps 1 to `last_step`; of the traces of a resumed run, the last one counts for each step.
// Throws InvalidInput with file and line.
RunTables read_run_tables(const RunLayout& layout, int last_step);

}  // namespace aspic::viewer
