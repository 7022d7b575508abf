// One frame of a run as an unstructured grid: all bodies, with the fields that a viewer colors by.
#pragma once
#include <filesystem>

#include "dynamics/simulation.h"
#include "dynamics/step_report.h"

namespace aspic {

// `report` of the step that ended there becomes numbers of the whole file; null for the start.
void write_frame(const std::filesystem::path& path, const Simulation& simulation, const StepReport* report,
                 bool double_precision = false);

}  // namespace aspic
