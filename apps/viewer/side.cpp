#include "viewer/side.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "scene/solver_options.h"

namespace aspic::viewer {

Side::Side(SteeredScene steered, size_t timeline_bytes) : steered_(std::move(steered)), timeline_(timeline_bytes) {
  const Simulation::Snapshot snapshot = simulation().snapshot();
  start_ = std::make_shared<const State>(snapshot.start);
  start_time_ = snapshot.start.time;
  scene_pins_ = pins_ = std::make_shared<const std::vector<Pin>>(model().pins);
  note_pins();
  stiffness_ = usual_stiffness(model());
  timeline_.add(moment());
}

View Side::view() const {
  return {simulation(), iteration_ >= 0 ? std::span<const double>(iterate_) : simulation().state().q, further_};
}

std::vector<Field> Side::fields() const {
  std::vector<Field> fields = fields_of(model());
  for (const TetField& own : further_) fields.push_back(own.field);
  return fields;
}

bool Side::has_field(const std::string& name) const {
  const std::vector<Field> all = fields();
  return std::any_of(all.begin(), all.end(), [&](const Field& f) { return f.name == name; });
}

// ---------------------------------------------------------------- moments

Moment Side::moment() const {
  Simulation::Snapshot now = simulation().snapshot();
  return {.step = now.steps_taken,
          .state = std::move(now.state),
          .previous = std::move(now.previous),
          .level = now.level,
          .outside_work = now.outside_work,
          .start_time = start_time_,
          .h = simulation().options().h,
          .integrator = simulation().options().integrator,
          .grab = resting(),
          .poke = resting_poke(),
          .pins = pins_,
          .settings = settings_};
}

// A simulation counts steps from its start: one that changed the length of its steps continues from its state when the
// start is moved to where as many steps of the new length would have begun.
Simulation::Snapshot Side::snapshot_of(const Moment& moment) const {
  const SimulationOptions& options = simulation().options();
  const bool is_same_step = options.h == moment.h;
  State start = *start_;
  start.time = is_same_step ? moment.start_time : moment.state.time - moment.step * options.h;
  return {.state = moment.state,
          .start = std::move(start),
          .steps_taken = moment.step,
          .level = moment.level,
          .previous = is_same_step && options.integrator == moment.integrator ? moment.previous : std::nullopt,
          .outside_work = moment.outside_work};
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
  hold_again(moment.poke);
}

void Side::note_edit() {
  const Grab acted = timeline_.last().acted;
  const Poke poked = timeline_.last().poked;
  const long settings = timeline_.last().settings;
  timeline_.drop_after(steps_taken() - 1);
  Moment now = moment();
  now.acted = acted;
  now.poked = poked;
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
  Poke poked = steered_.tip->poke();
  poke_.from = poke_.to = wanted_pose_;
  let_tip_rest();
  const double by_mouse = report.target_work[steered_.mouse_load], by_probe = report.target_work[steered_.tip_load];
  StepRow row{.report = report,
              .iterations = iterations_.take(),
              .mouse_work = by_mouse + mouse_jumps_,
              .probe_work = by_probe + tip_jumps_,
              .pin_work = report.pin_work - by_mouse - by_probe,
              .pins = pin_names(model()),
              .why = explain(simulation(), report)};
  mouse_jumps_ = tip_jumps_ = 0;
  if (acted.stiffness > 0) pulls_.push_back({steps_taken(), acted});
  rows_.add(std::move(row));
  Moment now = moment();
  now.acted = acted;
  now.poked = std::move(poked);
  timeline_.add(std::move(now));
  is_blown_up_ = report.status == Status::undefined && !simulation().integrator().is_implicit;
  return is_blown_up_ ? Progress::blown_up : Progress::stepped;
}

Progress Side::step(const StopToken& stop) {
  iterations_.begin();
  steered_.mouse->set(acting());
  steered_.tip->set(acting_poke());
  const StepReport report = simulated().step([&](const LiveIteration& live) { iterations_.add(live); }, stop);
  if (report.status != Status::interrupted) return complete(report);
  let_mouse_rest();
  let_tip_rest();
  return Progress::interrupted;
}

// The step is taken from its start as far as one iteration more, and given up when it would begin yet another one: what
// is left of it later are the same iterations once more, so no bit depends on how often it was looked at.
Progress Side::iterate(const StopToken& stop) {
  const int shown = iteration_ + 1;
  int count = 0;
  iterations_.begin();
  std::vector<double> iterate;
  steered_.mouse->set(acting());
  steered_.tip->set(acting_poke());
  const auto observe = [&](const LiveIteration& live) {
    if (count == shown) iterate.assign(live.x_next.begin(), live.x_next.end());
    if (count++ <= shown) iterations_.add(live);
  };
  const StepReport report = simulated().step(observe, StopToken([&] { return count > shown + 1 || stop.stopped(); }));
  if (report.status != Status::interrupted) return complete(report);
  let_mouse_rest();
  let_tip_rest();
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
  while (!pulls_.empty() && pulls_.back().step > moment.step) pulls_.pop_back();
  if (pins_ != moment.pins) ++settings_;
  stand_at(moment);
  is_blown_up_ = false;
  release();
}

StepReport Side::repeat(int step, const IterationObserver& observe, const StopToken& stop) {
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
  steered_.mouse->set(after ? after->acted : acting());
  steered_.tip->set(after ? after->poked : acting_poke());
  const StepReport report = simulated().step(observe, stop);
  simulated().restore(now);
  let_mouse_rest();
  let_tip_rest();
  return report;
}

// ---------------------------------------------------------------- settings

Side::Change Side::prepared(const std::string& override_text, const Announce& announce) const {
  Change change{.overrides = with_override(steered_.overrides, override_text)};
  const bool drops = override_text.find('=') == std::string::npos;  // what the scene's file says is read again
  if (!drops && is_of_solver_alone(key_of(override_text))) {
    change.document = overridden(steered_, override_text);
    change.solver = solver_options(*change.document.find("solver"));
    SimulationOptions options = simulation().options();
    options.solver = *change.solver;
    if (const auto conflict = find_conflict(options)) throw InvalidInput(conflict->reason);
    return change;
  }
  change.reloaded = load_steered(steered_.path, change.overrides, announce, steered_.most_tets);
  if (change.reloaded->scene.simulation.model().mesh.vertex_count() != model().mesh.vertex_count())
    throw InvalidInput(fmt::format("{} changes the mesh; load the scene anew with it", override_text));
  change.reloaded->tip->set(resting_poke());
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
  const double jumps = mouse_jumps_, tip_jumps = tip_jumps_;
  const Vec3d wanted = wanted_;
  const TipPose wanted_pose = wanted_pose_;
  steered_ = *std::move(change.reloaded);
  simulated().set_pins(*pins_);  // also where the scene would now choose others, such as the lowest vertices
  const Simulation::Snapshot snapshot = snapshot_of(now);
  simulated().restore(snapshot);
  start_time_ = snapshot.start.time;
  mouse_jumps_ = jumps;
  wanted_ = wanted;
  let_mouse_rest();
  tip_jumps_ = tip_jumps;
  wanted_pose_ = wanted_pose;
  let_tip_rest();
  note_edit();
}

}  // namespace aspic::viewer
