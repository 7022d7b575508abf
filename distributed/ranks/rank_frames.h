// Frames that all ranks write together.
#pragma once
#include <filesystem>

#include "ranks/distributed_simulation.h"
#include "results/run_directory_layout.h"

namespace aspic::distributed {

// Writes a piece per rank and their index; on one rank, the frame of aspic run. Pieces are in the user's order and have
// the fields "vertex" and "tet", the user's numbers. Vertices between ranks are in several pieces. Throws InvalidInput.
// Collective.
struct FrameOptions {
  int frame = 0;
  bool double_precision = false;
};
void write_pieces(const RunLayout& layout, const DistributedSimulation& simulation, const StepReport* report,
                  const FrameOptions& options);

}  // namespace aspic::distributed
