// Until when a computation may go on. What ends by it depends on the clock, and is not reproducible.
#pragma once
#include <chrono>
#include <functional>
#include <limits>

namespace aspic {

using WallClock = std::function<double()>;  // [s]

inline double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

class Deadline {
 public:
  Deadline() = default;  // never; no clock is read
  // In so many seconds. The clock must outlive this.
  Deadline(const WallClock& clock, double seconds) : clock_(&clock), begin_(clock()), end_(begin_ + seconds) {}

  bool exists() const { return clock_ != nullptr; }
  double now() const { return clock_ ? (*clock_)() : 0; }                                                // [s]
  double left() const { return clock_ ? end_ - (*clock_)() : std::numeric_limits<double>::infinity(); }  // [s]
  bool has_passed() const { return left() <= 0; }

  Deadline earlier_by(double seconds) const { return moved(end_ - seconds); }
  Deadline at_part(double part) const { return moved(begin_ + part * (end_ - begin_)); }  // of the time from the start

 private:
  Deadline moved(double end) const {
    Deadline moved = *this;
    moved.end_ = end;
    return moved;
  }

  const WallClock* clock_ = nullptr;
  double begin_ = 0, end_ = 0;
};

}  // namespace aspic
