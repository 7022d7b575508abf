// The state of a run of `aspic run --continue`: one line in outcome.txt, for `aspic sweep collect`.
#pragma once
#include <filesystem>
#include <functional>
#include <string>

#include "scene/scene.h"

namespace aspic::cli {

// The first word of a line; a reason may follow after ": ".
inline constexpr const char* kDone = "done";
inline constexpr const char* kUnconverged = "unconverged";  // complete, but steps did not converge
inline constexpr const char* kStopped = "stopped";          // by a signal or the time limit
inline constexpr const char* kFailed = "failed";
inline constexpr const char* kRunning = "running";  // or killed

std::string running_here();  // "running: on HOST"
std::string host_name();

// Both throw InvalidInput.
std::string read_outcome(const std::filesystem::path& run);  // empty: none
void write_outcome(const std::filesystem::path& run, const std::string& line);
// Runs the action. Records the reason if it throws, except if another process is computing the run.
int recorded(const std::filesystem::path& run, const std::function<int()>& action);

struct StepCounts {
  int last = 0, unconverged = 0;
};
// Counts the steps up to `last_step` in steps.csv. Throws InvalidInput.
StepCounts count_steps(const std::filesystem::path& run, int last_step);
bool has_checkpoint(const std::filesystem::path& run);
// Whether a process has computed the steps of this scene and written all files of the run, the outcome last.
bool is_complete(const std::filesystem::path& run, const Scene& scene, int last_step);

}  // namespace aspic::cli
