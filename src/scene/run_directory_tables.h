// The tables of a run. steps.csv and iterations.csv hold what is reproducible to the bit; timings.csv what is not.
#pragma once
#include <string>
#include <vector>

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

  void add_start(const StepReport& report);  // the row of step 0, which has no time of computation
  void add(const StepReport& report);
  void add(int step, const Iteration& iteration);
  void add_size(Checkpoint& checkpoint) const;  // of iterations.csv, whose steps have any number of rows
  void require_iterations(const Checkpoint& checkpoint) const;  // throws InvalidInput when rows are missing
  void sync();
  void close();

 private:
  CsvFile steps_, iterations_, timings_;
};

}  // namespace aspic
