// Progress of a run: one line that is redrawn on a terminal, occasional lines in a pipe.
#pragma once
#include <chrono>
#include <cstdio>
#include <string>

#include "dynamics/step_report.h"

namespace aspic::cli {

inline constexpr double kLineInterval = 10;  // time between two lines in a pipe [s]

size_t terminal_width(std::FILE* stream);  // [characters]; 80 if unknown

class Progress {
 public:
  Progress(std::FILE* stream, int first_step, int last_step);
  void show(const StepReport& report);
  void show(int step, const Iteration& iteration);  // for steps that last long
  void message(const std::string& line);            // separate line above the bar
  void finish();                                    // leaves the bar as it is

 private:
  double seconds() const;
  bool is_due(const StepReport& report) const;
  void print(std::string line, double done);  // `done`: fraction of the run
  void erase();

  using Clock = std::chrono::steady_clock;
  std::FILE* stream_;
  bool terminal_;
  int first_, last_;
  Clock::time_point start_ = Clock::now();
  double shown_at_ = -1e9;  // time since the start [s]
  int shown_step_ = 0;
  bool drawn_ = false;
};

std::string duration_text(double seconds);  // "12 s", "3 min 20 s", "2 h 05 min"

}  // namespace aspic::cli
