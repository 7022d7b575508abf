// Progress of a fit: one line that is redrawn on a terminal, occasional lines in a pipe.
#pragma once
#include <chrono>
#include <cstdio>
#include <string>

#include "capture/fit_run.h"

namespace aspic::cli {

class FitProgress {
 public:
  FitProgress(std::FILE* stream, bool every_iteration);
  void begin(FitStage stage, const std::string& what);
  void show(FitStage stage, const FitIteration& iteration, int residuals);
  void show(const std::string& line);     // skipped soon after the previous one
  void message(const std::string& line);  // separate line above the progress
  void finish();

 private:
  double seconds() const;
  void print(std::string line);
  void erase();

  using Clock = std::chrono::steady_clock;
  std::FILE* stream_;
  bool terminal_, every_iteration_;
  Clock::time_point start_ = Clock::now();
  double shown_at_ = -1e9;  // time since the start [s]
  bool drawn_ = false;
};

}  // namespace aspic::cli
