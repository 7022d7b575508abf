#pragma once
#include <chrono>
#include <ctime>

namespace aspic::bench {

struct Seconds {
  double wall = 0;
  double processor = 0;  // CPU time of all threads of this process [s]
};

// Time since the last lap, or since construction.
class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - wall_).count(); }  // wall time
  double cpu_seconds() const { return static_cast<double>(std::clock() - processor_) / CLOCKS_PER_SEC; }
  Seconds lap() {
    const Seconds passed{seconds(), cpu_seconds()};
    *this = {};
    return passed;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point wall_ = Clock::now();
  std::clock_t processor_ = std::clock();
};

}  // namespace aspic::bench
