// Wall time of the stages of a computation.
#pragma once

namespace aspic {

double steady_seconds();  // time of a clock that never goes backward [s]

class Stopwatch {
 public:
  // Returns the seconds since the last lap or the construction.
  double lap() {
    const double now = steady_seconds(), seconds = now - last_;
    last_ = now;
    return seconds;
  }

 private:
  double last_ = steady_seconds();
};

}  // namespace aspic
