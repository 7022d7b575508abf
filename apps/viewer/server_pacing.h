// The time of the next step at a requested speed of simulated time, and the measured speed.
#pragma once
#include <chrono>

namespace aspic::viewer {

class Pacing {
 public:
  using Clock = std::chrono::steady_clock;

  // Returns when the step after simulated time `time` [s] is due at `speed` [simulated s / s]. A long delay is not made
  // up for.
  Clock::time_point due(double time, double speed, Clock::time_point now);
  void pause() { speed_ = 0; }

 private:
  Clock::time_point start_;  // wall time of `start_time_`
  double start_time_ = 0, last_time_ = 0, speed_ = 0;
};

// Simulated time per wall time, averaged over about half a second.
class Rate {
 public:
  using Clock = Pacing::Clock;

  void start(double time, Clock::time_point now);
  bool update(double time, Clock::time_point now);  // returns whether value() has changed
  double value() const { return value_; }

 private:
  Clock::time_point start_;
  double start_time_ = 0, value_ = 0;
};

}  // namespace aspic::viewer
