// When the next step is due, so that simulated time passes at the speed that was asked for; and how fast it does pass.
#pragma once
#include <chrono>

namespace aspic::viewer {

class Pacing {
 public:
  using Clock = std::chrono::steady_clock;

  // The next step after simulated time `time` [s] at `speed` [s of simulation per s]. Who is behind is not made to
  // catch up: lost time is forgotten.
  Clock::time_point due(double time, double speed, Clock::time_point now);
  void pause() { speed_ = 0; }

 private:
  Clock::time_point start_;  // when `start_time_` was simulated
  double start_time_ = 0, last_time_ = 0, speed_ = 0;
};

// Simulated time per wall time over about the last half second.
class Rate {
 public:
  using Clock = Pacing::Clock;

  void start(double time, Clock::time_point now);
  bool update(double time, Clock::time_point now);  // whether value() is another one
  double value() const { return value_; }

 private:
  Clock::time_point start_;
  double start_time_ = 0, value_ = 0;
};

}  // namespace aspic::viewer
