#include "aspic/sweep/outcome.h"

#include <unistd.h>

#include <array>
#include <new>

#include "base/error.h"
#include "dynamics/step_report.h"
#include "io/atomic_file.h"
#include "io/checkpoint.h"
#include "io/csv_reader.h"
#include "results/run_directory_layout.h"
#include "results/run_lock.h"

namespace aspic::cli {
namespace {

namespace fs = std::filesystem;

// Creates the folder if it does not exist. Does nothing in folders of others, or if writing fails.
void record_failure(const fs::path& run, const std::string& reason) {
  try {
    const RunLayout layout(run);
    std::error_code error;
    fs::create_directories(run, error);
    if (!layout.is_barely_begun() && !layout.holds_run()) return;
    write_outcome(run, std::string(kFailed) + ": " + reason.substr(0, reason.find('\n')));
  } catch (const InvalidInput&) {  // the caller reports the reason
  }
}

}  // namespace

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

std::string running_here() { return std::string(kRunning) + ": on " + host_name(); }

std::string read_outcome(const fs::path& run) {
  const fs::path file = RunLayout(run).outcome();
  std::error_code error;
  if (!fs::exists(file, error)) return "";
  const std::string text = read_file(file);
  return text.substr(0, text.find('\n'));
}

void write_outcome(const fs::path& run, const std::string& line) {
  if (read_outcome(run) != line) write_file(RunLayout(run).outcome(), line + "\n");
}

int recorded(const fs::path& run, const std::function<int()>& action) {
  try {
    return action();
  } catch (const FolderInUse&) {
    throw;
  } catch (const std::bad_alloc&) {
    record_failure(run, "out of memory");
    throw;
  } catch (const std::exception& error) {
    record_failure(run, error.what());
    throw;
  }
}

StepCounts count_steps(const fs::path& run, int last_step) {
  CsvReader steps(RunLayout(run).steps());
  const size_t step_column = steps.column("step"), status_column = steps.column("status");
  StepCounts counts;
  while (steps.next()) {
    const int step = steps.integer(step_column);
    if (step == 0) continue;
    if (step > last_step) break;
    counts.last = step;
    const auto is = [&](Status status) { return steps.text(status_column) == to_string(status); };
    if (!is(Status::converged) && !is(Status::round_off) && !is(Status::budget)) ++counts.unconverged;
  }
  return counts;
}

bool has_checkpoint(const fs::path& run) {
  const fs::path newest = RunLayout(run).checkpoint();
  std::error_code error;
  return fs::exists(newest, error) || fs::exists(previous_checkpoint(newest), error);
}

bool is_complete(const fs::path& run, const Scene& scene, int last_step) {
  const std::string outcome = read_outcome(run);
  if (outcome != kDone && outcome != kUnconverged) return false;
  const RunLayout layout(run);
  std::error_code error;
  if (!layout.holds_run() || !fs::exists(layout.checkpoint(), error)) return false;
  const Checkpoint checkpoint = read_checkpoint(layout.checkpoint());
  return checkpoint.fingerprint == fingerprint(scene.resolved) && checkpoint.integer("steps_taken") >= last_step &&
         count_steps(run, last_step).last == last_step;
}

}  // namespace aspic::cli
