// The tables of a run. steps.csv and iterations.csv are bit-reproducible, timings.csv is not.
#pragma once
#include <array>

#include "dynamics/simulation.h"
#include "io/checkpoint.h"
#include "io/csv.h"

namespace aspic {

inline constexpr const char* kStepsHead = "step,time,status,criterion,";

class RunLayout;

class RunTables {
 public:
  static RunTables create(const RunLayout& layout, const Simulation& simulation);
  static RunTables resume(const RunLayout& layout, const Simulation& simulation);  // after the steps it has taken

  void add_start(const StepReport& report);  // row of step 0, without wall time
  void add(const StepReport& report);
  void add(int step, const Iteration& iteration);
  // Sizes and checksums of the reproducible tables.
  void add_sizes(Checkpoint& checkpoint) const;
  // Throws InvalidInput if rows are missing or have changed.
  void require_unchanged(const Checkpoint& checkpoint) const;
  void sync();
  void close();

 private:
  CsvFile steps_, iterations_, timings_;
  std::array<double, 5> stages_ = {};  // seconds of the iterations since the last step, as in timings.csv
};

}  // namespace aspic
