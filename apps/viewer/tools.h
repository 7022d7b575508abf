// The tools that act on a body: the hand, a spring that pulls one of its points, and the indenter.
#pragma once
#include <memory>

#include "energy/grab_spring.h"
#include "energy/held_tip.h"
#include "viewer/surface.h"

namespace aspic::viewer {

struct Interval {
  double begin = 0, end = 0;  // [s]
};

// A tool rests between steps. Within a step it moves from its place to its wanted place. `Held` is a load with the
// members from, to, from_time and to_time.
template <class Held, class Place>
class Tool {
 public:
  Held resting(double time) const { return moving(held_.to, {time, time}); }  // [s]
  Held acting(const Interval& step) const { return moving(wanted_, step); }
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

class Hand : public Tool<Grab, Vec3d> {
 public:
  explicit Hand(double stiffness) : stiffness_(stiffness) {}

  bool is_grabbing() const { return held_.stiffness > 0; }
  double stiffness() const { return stiffness_; }  // stiffness of current and later grabs [N/m]
  Vec3d point(Positions x) const { return held_.point(x); }
  Vec3d force(Positions x) const { return is_grabbing() ? held_.stiffness * (place() - point(x)) : Vec3d{}; }  // [N]
  double energy(Positions x) const { return held_.value(x, place()); }                                         // [J]

  void grab(const TetPoint& point, const Vec3d& target, Positions x) {
    held_ = {.vertices = point.vertices, .weights = point.weights, .stiffness = stiffness_};
    held_.from = held_.to = held_.point(x);
    move(target);
  }
  void release() { held_ = {}; }
  void set_stiffness(double stiffness) {
    stiffness_ = stiffness;
    if (is_grabbing()) held_.stiffness = stiffness;
  }

 private:
  double stiffness_;
};

class Indenter : public Tool<Poke, TipPose> {
 public:
  const Touch* touch() const { return held_.touch.get(); }  // null: no indenter
  void touch(const std::shared_ptr<const Touch>& touch) { return_to({touch, touch->begun, touch->begun}); }
  void lift() { return_to({}); }
};

struct Tools {
  Hand hand;
  Indenter indenter = {};
};

}  // namespace aspic::viewer
