// Cooperative cancellation of long computations.
#pragma once
#include <functional>
#include <limits>
#include <memory>
#include <utility>

#include "base/stopwatch.h"

namespace aspic {

using WallClock = std::function<double()>;  // returns seconds since any fixed time

// Stops a computation in one of two ways. A request discards the current work: the computation ends at its next poll of
// the token with status `interrupted`. A deadline keeps the best result: the status is `budget`. Results that end at a
// deadline depend on the clock. Copies are cheap and share the request.
class StopToken {
 public:
  StopToken() = default;  // never stops and reads no clock
  // `requested` is polled often, from one thread at a time. Once true, it must remain true.
  explicit StopToken(std::function<bool()> requested)
      : requested_(std::make_shared<const std::function<bool()>>(std::move(requested))) {}
  // Sets a deadline in seconds from now. The clock must outlive the token and its copies.
  StopToken(const WallClock& clock, double seconds) : clock_(&clock), begin_(clock()), end_(begin_ + seconds) {}

  bool requested() const { return requested_ && (*requested_)(); }
  bool has_deadline() const { return clock_ != nullptr; }
  bool expired() const { return seconds_left() <= 0; }  // the deadline has passed
  bool stopped() const { return requested() || expired(); }
  double now() const { return clock_ ? (*clock_)() : 0; }  // time of the clock [s]; 0 without a deadline
  // Returns the time until the deadline, negative after it [s]; infinite without a deadline.
  double seconds_left() const { return clock_ ? end_ - (*clock_)() : std::numeric_limits<double>::infinity(); }

  // Returns a token with the same request and another deadline.
  StopToken with_deadline(const WallClock& clock, double seconds) const {
    StopToken token(clock, seconds);
    token.requested_ = requested_;
    return token;
  }
  StopToken without_deadline() const {  // keeps the request
    StopToken token;
    token.requested_ = requested_;
    return token;
  }
  // Return a token whose deadline is at a fraction of the initial time span, or earlier by a number of seconds.
  StopToken at_fraction(double fraction) const { return ending_at(begin_ + fraction * (end_ - begin_)); }
  StopToken earlier_by(double seconds) const { return ending_at(end_ - seconds); }
  // Returns a token whose deadline discards the current work, like a request.
  StopToken discarding() const {
    return has_deadline() ? StopToken([token = *this] { return token.stopped(); }) : *this;
  }

 private:
  StopToken ending_at(double end) const {
    StopToken token = *this;
    token.end_ = end;
    return token;
  }

  std::shared_ptr<const std::function<bool()>> requested_;
  const WallClock* clock_ = nullptr;
  double begin_ = 0, end_ = 0;
};

}  // namespace aspic
