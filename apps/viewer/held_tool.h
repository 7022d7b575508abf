// The place of a tool that pages move.
#pragma once
#include "viewer/extension.h"

namespace aspic::viewer {

// What acts on a body at a place, such as the hand, a spring that pulls a point. It rests between steps. Within a step
// it moves from its place to its wanted place. `Held` is a load with the members from, to, from_time and to_time.
template <class Held, class Place>
class HeldTool {
 public:
  Held resting(double time) const { return moving(held_.to, {time, time}); }  // [s]
  Held acting(const Interval& step) const { return moving(wanted_, step); }
  const Held& held() const { return held_; }
  const Place& place() const { return held_.to; }
  const Place& wanted() const { return wanted_; }  // at the end of the next step
  void move(const Place& wanted) { wanted_ = wanted; }
  void finish_step() { held_.from = held_.to = wanted_; }
  void return_to(const Held& held) { held_ = held, wanted_ = held.to; }

 protected:
  Held held_;

 private:
  Held moving(const Place& to, const Interval& interval) const {
    Held held = held_;
    held.from = held_.to;
    held.to = to;
    held.from_time = interval.begin;
    held.to_time = interval.end;
    return held;
  }

  Place wanted_{};
};

}  // namespace aspic::viewer
