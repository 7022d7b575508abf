// Writes one frame of a run as a VTU file: all bodies with their fields.
#pragma once
#include <filesystem>

#include "dynamics/simulation.h"
#include "dynamics/step_report.h"
#include "io/vtu.h"

namespace aspic {

struct FrameContents {
  bool double_precision = false, mechanics = false;  // see OutputOptions
};

// Returns the fields of a frame in the storage order of the model. `report`: see write_frame().
VtuFields frame_fields(const Simulation& simulation, const StepReport* report, FrameContents contents);

// `report`: the step that ends at the frame, written as field data; null for the start.
void write_frame(const std::filesystem::path& path, const Simulation& simulation, const StepReport* report,
                 FrameContents contents = {});

}  // namespace aspic
