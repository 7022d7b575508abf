// What the hand does to a side with the probe.
#include "base/error.h"
#include "viewer/side.h"

namespace aspic::viewer {

Poke Side::resting_poke() const {
  Poke poke = poke_;
  poke.from = poke.to;
  poke.from_time = poke.to_time = time();
  return poke;
}

// Within the next step: from where the tip was at its start to where it is by now.
Poke Side::acting_poke() const {
  Poke poke = poke_;
  poke.from = poke_.to;
  poke.to = wanted_pose_;
  poke.from_time = time();
  poke.to_time = end_of_next_step();
  return poke;
}

void Side::let_tip_rest() { steered_.tip->set(resting_poke()); }

void Side::change_poke(const Poke& poke) {
  const std::vector<double>& q = simulation().state().q;
  const double before = steered_.tip->value(q);
  steered_.tip->set(poke);
  leave_step();
  tip_jumps_ += steered_.tip->value(q) - before;
  poke_ = poke;
  wanted_pose_ = poke.to;
  let_tip_rest();
  note_edit();
}

// As at an earlier moment; a body that had another shape then is not touched where it is no more.
void Side::hold_again(const Poke& poke) {
  poke_ = poke;
  try {
    let_tip_rest();
  } catch (const InvalidInput&) {
    poke_ = {};
    let_tip_rest();
  }
  wanted_pose_ = poke_.to;
  tip_jumps_ = 0;
}

void Side::touch(std::shared_ptr<const Touch> touch) {
  Poke poke{.touch = std::move(touch), .from = {}, .to = {}};
  poke.from = poke.to = poke.touch->begun;
  poke.from_time = poke.to_time = time();
  change_poke(poke);
}

void Side::press(const TipPose& pose) {
  leave_step();
  wanted_pose_ = pose;
}

void Side::lift() {
  if (poke_.touch) change_poke({});
}

}  // namespace aspic::viewer
