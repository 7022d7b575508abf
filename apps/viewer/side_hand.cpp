// What the hand does to a side: its spring, and the pins that it puts.
#include "viewer/side.h"

namespace aspic::viewer {
namespace {

double spring_energy(const Grab& grab, const Vec3d& target, std::span<const double> x) {
  if (grab.stiffness == 0) return 0;
  const Vec3d u = grab.point(x) - target;
  return 0.5 * grab.stiffness * dot(u, u);
}

}  // namespace

// ---------------------------------------------------------------- the mouse

Grab Side::resting() const {
  Grab grab = grab_;
  grab.from = grab.to;
  grab.from_time = grab.to_time = time();
  return grab;
}

double Side::end_of_next_step() const { return start_time_ + (steps_taken() + 1) * simulation().options().h; }

// Within the next step: from where the hand was at its start to where it is by now.
Grab Side::acting() const {
  Grab grab = grab_;
  grab.from = grab_.to;
  grab.to = wanted_;
  grab.from_time = time();
  grab.to_time = end_of_next_step();
  return grab;
}

void Side::let_mouse_rest() { steered_.mouse->set(resting()); }

void Side::change_grab(const Grab& grab) {
  leave_step();
  const std::vector<double>& q = simulation().state().q;
  mouse_jumps_ += spring_energy(grab, grab.to, q) - spring_energy(grab_, grab_.to, q);
  grab_ = grab;
  let_mouse_rest();
  note_edit();
}

void Side::grab(const TetPoint& point, const Vec3d& target) {
  Grab grab{.vertices = point.vertices, .weights = point.weights, .stiffness = stiffness_};
  grab.from = grab.to = grab.point(simulation().state().q);
  change_grab(grab);
  wanted_ = target;
}

void Side::move(const Vec3d& target) {
  leave_step();
  wanted_ = target;
}

void Side::release() {
  if (is_grabbed()) change_grab({});
}

void Side::set_stiffness(double stiffness) {
  stiffness_ = stiffness;
  if (!is_grabbed()) return;
  Grab grab = grab_;
  grab.stiffness = stiffness;
  change_grab(grab);
}

Vec3d Side::mouse_force() const {
  if (!is_grabbed()) return {};
  return grab_.stiffness * (grab_.to - grabbed_point());
}

// ---------------------------------------------------------------- pins by hand

void Side::note_pins() {
  pinned_.assign(model().mesh.vertex_count(), 0);
  for (const Pin& pin : *pins_)
    for (const int v : pin.vertices) pinned_[v] = 1;
}

void Side::pin(const std::vector<int>& vertices, bool pinned) {
  std::vector<char> chosen(pinned_.size(), 0);
  for (const int v : vertices) chosen[v] = 1;
  std::vector<Pin> pins;
  for (const Pin& old : *pins_) {
    Pin kept = old;
    if (!pinned) std::erase_if(kept.vertices, [&](int v) { return chosen[v]; });
    if (!kept.vertices.empty()) pins.push_back(std::move(kept));
  }
  const std::vector<double>& q = simulation().state().q;
  for (int v = 0; pinned && v < static_cast<int>(chosen.size()); ++v) {
    if (!chosen[v] || pinned_[v]) continue;
    const Vec3d here{{q[3 * v], q[3 * v + 1], q[3 * v + 2]}};
    pins.push_back({"by hand", {v}, [here](const Vec3d&, double) { return here; }});
  }
  simulated().set_pins(pins);
  leave_step();
  ++settings_;
  pins_ = std::make_shared<const std::vector<Pin>>(std::move(pins));
  note_pins();
  note_edit();
}

}  // namespace aspic::viewer
