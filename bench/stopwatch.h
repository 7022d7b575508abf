#pragma once
#include <chrono>
#include <ctime>

namespace aspic::bench {

struct Seconds {
  double wall = 0;
  double processor = 0;  // of all threads of this process
};

// Time since the last lap, or since it was made.
class Stopwatch {
 public:
  Seconds lap() {
    const auto now = Clock::now();
    const std::clock_t processor = std::clock();
    const Seconds seconds{std::chrono::duration<double>(now - wall_).count(),
                          static_cast<double>(processor - processor_) / CLOCKS_PER_SEC};
    wall_ = now;
    processor_ = processor;
    return seconds;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point wall_ = Clock::now();
  std::clock_t processor_ = std::clock();
};

}  // namespace aspic::bench
