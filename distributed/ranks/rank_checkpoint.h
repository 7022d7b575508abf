// Checkpoints that all ranks write and read together, each a slice in the user's order. The files are those of aspic
// run, so any number of ranks can continue.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/simulation.h"
#include "io/checkpoint.h"
#include "ranks/user_order.h"

namespace aspic::distributed {

// What rank 0 adds to the state.
struct CheckpointFacts {
  std::string fingerprint;  // of the scene
  std::vector<double> frame_times;
  std::vector<std::pair<std::string, std::int64_t>> integers;  // besides the number of steps
};

// `local`: of the own vertices and ghosts. `facts`: used on rank 0. Throws std::runtime_error if the file cannot be
// written. Collective.
void write_slices(const std::filesystem::path& path, const Simulation::Snapshot& local, const UserOrder& order,
                  const CheckpointFacts& facts);

struct RankCheckpoint {
  Simulation::Snapshot own;  // of the own vertices
  Checkpoint head;           // on rank 0: fingerprint, integers and the array frame_times
  std::string note;          // why it is not the newest one; empty if it is
};
// Reads the newest checkpoint with a correct checksum. Throws Refused. Collective.
RankCheckpoint read_slices(const std::filesystem::path& path, const UserOrder& order);

}  // namespace aspic::distributed
