// The tables of a run. steps.csv and iterations.csv hold what is reproducible to the bit; timings.csv what is not.
#pragma once
#include <string>
#include <vector>

#include "dynamics/step_report.h"
#include "io/checkpoint.h"
#include "io/csv.h"

namespace aspic {

inline constexpr const char* kStepsHead = "step,time,status,criterion,";

class RunLayout;

class RunTables {
 public:
  static RunTables create(const RunLayout& layout, const std::vector<std::string>& potential_names);
  static RunTables resume(const RunLayout& layout, const std::vector<std::string>& potential_names, int last_step);

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
