// The loop over the steps of a run, on one process (`aspic run`) or on several ranks (`aspic-mpi run`): progress,
// warnings, totals, and the reasons to stop.
#pragma once
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "aspic/progress.h"
#include "aspic/summary.h"
#include "base/stop_token.h"
#include "dynamics/simulation.h"
#include "results/explanation.h"

namespace aspic::cli {

// What the loop advances and records.
class SteppedRun {
 public:
  virtual ~SteppedRun() = default;
  virtual const Simulation& simulation() const = 0;  // on several ranks the part of this one
  virtual StepReport step(const IterationObserver& observe, const StopToken& stop) = 0;
  // Writes the step. Returns why it did not converge, or is less accurate than requested.
  virtual Explanation record(const StepReport& report, const std::vector<Iteration>& iterations) = 0;
  virtual int signal() = 0;  // that ends the run, the same on all ranks; 0: none
};

struct LoopOptions {
  int last_step = 0;
  bool warns = true;              // prints warnings to stderr
  std::FILE* progress = nullptr;  // shows the progress; null: quiet
  StopToken stop;
};

class StepLoop {
 public:
  StepLoop(SteppedRun& run, LoopOptions options);

  // Stops early after a signal or at the deadline. Discards an unfinished step, so the output ends with a complete
  // step.
  void run();

  bool has_blown_up() const { return has_blown_up_; }  // an explicit scheme
  bool has_run_out() const { return has_run_out_; }    // of time
  int last_step() const { return options_.last_step; }
  const RunTotals& totals() const { return totals_; }

 private:
  bool advance();  // false: the run ends before its last step
  void record(const StepReport& report);
  void warn(const StepReport& report, const Explanation& why);
  void print(const std::string& line);

  SteppedRun& run_;
  LoopOptions options_;
  bool has_blown_up_ = false, has_run_out_ = false, has_warned_of_round_off_ = false;
  std::optional<Progress> progress_;
  std::vector<Iteration> iterations_;  // of the step in progress; recorded at its end
  RunTotals totals_;
  std::string last_cause_;  // last explained cause
};

}  // namespace aspic::cli
