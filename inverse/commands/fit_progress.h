// Progress of a fit: one line that is redrawn on a terminal, occasional lines in a pipe.
#pragma once
#include <cstdio>
#include <string>

#include "aspic/progress.h"
#include "pipeline/fit_run.h"

namespace aspic::cli {

// Duration of a fit of single values relative to that of its first iteration, within about a factor of 2. Fields,
// regions and comparisons of laws take longer.
double least_duration(const FitPlan& plan, const Measured& experiment);

class FitProgress : public StatusLine {
 public:
  FitProgress(std::FILE* stream, bool every_iteration);
  void begin(FitStage stage, const std::string& what);
  void show(FitStage stage, const FitIteration& iteration, int residuals);
  void show(const std::string& line);                                   // skipped soon after the previous one
  void message(const std::string& line);                                // separate line above the progress
  void show_expected(const FitPlan& plan, const Measured& experiment);  // duration, from the time until now
  void finish();

 private:
  bool every_iteration_;
};

}  // namespace aspic::cli
