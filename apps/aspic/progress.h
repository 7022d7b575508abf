// Progress of a run: one line that is redrawn on a terminal, occasional lines in a pipe.
#pragma once
#include <cstdio>
#include <string>
#include <vector>

#include "base/stop_token.h"
#include "dynamics/step_report.h"

namespace aspic::cli {

inline constexpr double kLineInterval = 10;  // time between two lines in a pipe [s]

class StatusLine {
 public:
  explicit StatusLine(std::FILE* stream, WallClock clock = steady_seconds);

 protected:
  double seconds() const { return clock_() - start_; }
  void draw(std::string line);  // on a terminal over the previous one
  void erase();

  std::FILE* stream_;
  bool terminal_;
  double shown_at_ = -1e9;  // time since the start [s]
  bool drawn_ = false;

 private:
  WallClock clock_;
  double start_;
};

class Progress : public StatusLine {
 public:
  Progress(std::FILE* stream, int first_step, int last_step, WallClock clock = steady_seconds);
  void show(const StepReport& report);
  void show(int step, const Iteration& iteration);  // for steps that last long
  void message(const std::string& line);            // separate line above the bar
  void finish();                                    // leaves the bar as it is

 private:
  bool is_due(const StepReport& report) const;
  void print(std::string line, double done);  // `done`: fraction of the run
  double seconds_per_step() const;            // mean of recent steps, because steps in contact take longer

  int first_, last_, shown_step_;
  std::vector<double> ends_ = {0};  // start of the first step, and end of each [s]
};

std::string duration_text(double seconds);  // "12 s", "3 min 20 s", "2 h 05 min"

}  // namespace aspic::cli
