// When a session takes its next step and shows its next pictures. Independent of threads: the server and the worker of
// the browser use it.
#pragma once
#include <chrono>
#include <functional>
#include <optional>

#include "viewer/session.h"

namespace aspic::viewer {

// The time of the next step at a requested speed of simulated time.
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

class PacedSession {
 public:
  using Clock = Pacing::Clock;

  explicit PacedSession(Session& session) : session_(session) {}

  // Call after each change of the session. Returns whether it plays and its next step is due.
  bool is_step_due();
  // Takes the steps that are due; short ones together, until `is_awaited` returns true. Returns the messages for all
  // pages.
  Messages advance(const std::function<bool()>& is_awaited);

  // Whether there are new pictures, and the last ones have been visible for long enough.
  bool are_pictures_due() const;
  Messages pictures();
  long shown_version() const { return *shown_; }  // picture_version() of the last pictures; requires some

  // Returns when the next step is due, or the next pictures if they are requested; none: after a change only.
  std::optional<Clock::time_point> next(bool wants_pictures) const;

 private:
  Session& session_;
  Pacing pacing_;
  Rate rate_;
  bool was_playing_ = false;
  Clock::time_point next_step_, next_picture_;
  std::optional<long> shown_;
};

}  // namespace aspic::viewer
