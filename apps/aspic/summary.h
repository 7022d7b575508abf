// What a run amounted to, and how to look at its results.
#pragma once
#include <cstdio>
#include <filesystem>
#include <string>

#include "dynamics/step_report.h"

namespace aspic::cli {

struct RunTotals {
  int steps = 0, unconverged = 0;
  int out_of_time = 0;  // ended by solver.time_budget, which was asked for: not among the unconverged
  long iterations = 0;
  long values = 0, gradients = 0, hessians = 0, factorizations = 0, products = 0, cycles = 0;
  int most_iterations = 0;
  long substeps = 0, rejected = 0;  // of adaptive steps
  double seconds = 0;               // in steps
  double time = 0;                  // of the last step [s]

  void add(const StepReport& report);
};

struct RunEnd {
  int last_step = 0, steps_taken = 0;
  bool interrupted = false, blown_up = false;
  std::string solver;  // the methods and what they chose, and why; empty: none was needed
  std::filesystem::path directory;
};

void print_summary(std::FILE* stream, const RunTotals& totals, const RunEnd& end);

}  // namespace aspic::cli
