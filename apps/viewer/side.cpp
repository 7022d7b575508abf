#include "viewer/side.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "scene/solver_options.h"

namespace aspic::viewer {
namespace {

double spring_energy(const Grab& grab, const Vec3d& target, std::span<const double> x) {
  if (grab.stiffness == 0) return 0;
  const Vec3d u = grab.point(x) - target;
  return 0.5 * grab.stiffness * dot(u, u);
}

}  // namespace

Side::Side(SteeredScene steered, size_t timeline_bytes) : steered_(std::move(steered)), timeline_(timeline_bytes) {
  const Simulation::Snapshot snapshot = simulation().snapshot();
  start_ = std::make_shared<const State>(snapshot.start);
  start_time_ = snapshot.start.time;
  pins_ = std::make_shared<const std::vector<Pin>>(model().pins);
  note_pins();
  stiffness_ = usual_stiffness(model());
  timeline_.add(moment());
}

View Side::view() const {
  return {simulation(), iteration_ >= 0 ? std::span<const double>(iterate_) : simulation().state().q};
}

// ---------------------------------------------------------------- moments

Moment Side::moment() const {
  Simulation::Snapshot now = simulation().snapshot();
  return {.step = now.steps_taken,
          .state = std::move(now.state),
          .previous = std::move(now.previous),
          .level = now.level,
          .start_time = start_time_,
          .h = simulation().options().h,
          .integrator = simulation().options().integrator,
          .grab = resting(),
          .pins = pins_,
          .settings = settings_};
}

// A simulation counts steps from its start: one that changed the length of its steps goes on from where it is when the
// start is put to where as many steps of the new length would have begun.
Simulation::Snapshot Side::snapshot_of(const Moment& moment) const {
  const SimulationOptions& options = simulation().options();
  const bool is_same_step = options.h == moment.h;
  State start = *start_;
  start.time = is_same_step ? moment.start_time : moment.state.time - moment.step * options.h;
  return {.state = moment.state,
          .start = std::move(start),
          .steps_taken = moment.step,
          .level = moment.level,
          .previous = is_same_step && options.integrator == moment.integrator ? moment.previous : std::nullopt};
}

void Side::stand_at(const Moment& moment) {
  const Simulation::Snapshot snapshot = snapshot_of(moment);
  simulated().restore(snapshot);
  start_time_ = snapshot.start.time;
  if (pins_ != moment.pins) {
    pins_ = moment.pins;
    simulated().set_pins(*pins_);
    note_pins();
  }
  grab_ = moment.grab;
  wanted_ = grab_.to;
  mouse_jumps_ = 0;
  let_mouse_rest();
}

void Side::note_edit() {
  const Grab acted = timeline_.last().acted;
  const long settings = timeline_.last().settings;
  timeline_.drop_after(steps_taken() - 1);
  Moment now = moment();
  now.acted = acted;
  now.settings = settings;
  timeline_.add(std::move(now));
}

void Side::leave_step() { iteration_ = -1; }

// ---------------------------------------------------------------- steps

Progress Side::complete(const StepReport& report) {
  leave_step();
  Grab acted = steered_.mouse->grab();
  grab_.from = grab_.to = wanted_;
  let_mouse_rest();
  StepRow row{.report = report,
              .iterations = iterations_.take(),
              .mouse_work = report.target_work[steered_.mouse_load] + mouse_jumps_,
              .pin_work = report.pin_work - report.target_work[steered_.mouse_load],
              .why = explain(simulation(), report)};
  mouse_jumps_ = 0;
  rows_.add(std::move(row));
  Moment now = moment();
  now.acted = acted;
  timeline_.add(std::move(now));
  is_blown_up_ = report.status == Status::undefined && !simulation().is_implicit();
  return is_blown_up_ ? Progress::blown_up : Progress::stepped;
}

Progress Side::step(const Consent& go_on) {
  iterations_.begin();
  steered_.mouse->set(acting(), time());
  const auto observe = [&](const LiveIteration& live) {
    iterations_.add(live);
    return go_on();
  };
  const StepReport report = simulated().step(observe, go_on);
  if (report.status != Status::interrupted) return complete(report);
  let_mouse_rest();
  return Progress::interrupted;
}

// The step is taken from its start as far as one iteration more, and given up when it would begin yet another one: what
// is left of it later are the same iterations once more, so no bit depends on how often it was looked at.
Progress Side::iterate(const Consent& go_on) {
  const int shown = iteration_ + 1;
  int count = 0;
  iterations_.begin();
  std::vector<double> iterate;
  steered_.mouse->set(acting(), time());
  const auto observe = [&](const LiveIteration& live) {
    if (count == shown) iterate.assign(live.x_next.begin(), live.x_next.end());
    if (count++ > shown) return false;
    iterations_.add(live);
    return go_on();
  };
  const StepReport report = simulated().step(observe, go_on);
  if (report.status != Status::interrupted) return complete(report);
  let_mouse_rest();
  if (count <= shown + 1) return Progress::interrupted;
  iterate_ = std::move(iterate);
  iteration_ = shown;
  return Progress::iterated;
}

void Side::rewind(int step) {
  leave_step();
  const Moment moment = timeline_.nearest(step);
  timeline_.drop_after(moment.step);
  rows_.drop_after(moment.step);
  if (pins_ != moment.pins) ++settings_;
  stand_at(moment);
  is_blown_up_ = false;
  release();
}

StepReport Side::repeat(int step, const IterationObserver& observe) {
  const bool is_next = step == steps_taken() + 1;
  const Moment* before = is_next ? &timeline_.last() : timeline_.find(step - 1);
  const Moment* after = is_next ? nullptr : timeline_.find(step);
  if (!before || (!is_next && !after))
    throw InvalidInput(fmt::format("step {} cannot be repeated: {}", step,
                                   step < 1 || step > steps_taken() + 1
                                       ? fmt::format("there are steps 1 to {}", steps_taken() + 1)
                                       : "where it began is no longer remembered (look at a later one)"));
  if (after && after->settings != settings_)
    throw InvalidInput(
        fmt::format("step {} was taken with other settings or pins than now, so it cannot be repeated", step));
  const Simulation::Snapshot now = simulation().snapshot();
  simulated().restore(snapshot_of(*before));
  steered_.mouse->set(after ? after->acted : acting(), before->state.time);
  const StepReport report = simulated().step(observe);
  simulated().restore(now);
  let_mouse_rest();
  return report;
}

// ---------------------------------------------------------------- settings

Side::Change Side::prepared(const std::string& override_text, const Announce& announce) const {
  Change change{.overrides = with_override(steered_.overrides, override_text)};
  if (is_of_solver_alone(key_of(override_text))) {
    change.document = overridden(steered_, override_text);
    change.solver = solver_options(*change.document.find("solver"));
    SimulationOptions options = simulation().options();
    options.solver = *change.solver;
    if (const auto conflict = find_conflict(options)) throw InvalidInput(conflict->reason);
    return change;
  }
  change.reloaded = load_steered(steered_.path, change.overrides, announce);
  if (change.reloaded->scene.simulation.model().mesh.vertex_count() != model().mesh.vertex_count())
    throw InvalidInput(fmt::format("{} changes the mesh; load the scene anew with it", override_text));
  return change;
}

void Side::apply(Change change) {
  leave_step();
  is_blown_up_ = false;
  ++settings_;
  if (change.solver) {
    simulated().set_solver(*change.solver);
    steered_.scene.resolved = to_toml(change.document);
    steered_.document = std::move(change.document);
    steered_.overrides = std::move(change.overrides);
    return;
  }
  const Moment now = moment();
  const double jumps = mouse_jumps_;
  const Vec3d wanted = wanted_;
  steered_ = *std::move(change.reloaded);
  simulated().set_pins(*pins_);  // also where the scene would now choose others, such as the lowest vertices
  const Simulation::Snapshot snapshot = snapshot_of(now);
  simulated().restore(snapshot);
  start_time_ = snapshot.start.time;
  mouse_jumps_ = jumps;
  wanted_ = wanted;
  let_mouse_rest();
  note_edit();
}

// ---------------------------------------------------------------- the mouse

Grab Side::resting() const {
  Grab grab = grab_;
  grab.from = grab.to;
  grab.from_time = grab.to_time = time();
  return grab;
}

// Within the next step: from where the hand was at its start to where it is by now.
Grab Side::acting() const {
  Grab grab = grab_;
  grab.from = grab_.to;
  grab.to = wanted_;
  grab.from_time = time();
  grab.to_time = start_time_ + (steps_taken() + 1) * simulation().options().h;
  return grab;
}

void Side::let_mouse_rest() { steered_.mouse->set(resting(), time()); }

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
