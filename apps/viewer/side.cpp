#include "viewer/side.h"

#include <utility>

#include "base/error.h"
#include "dynamics/mesh_error_text.h"
#include "viewer/default_stiffness.h"

namespace aspic::viewer {

Side::Side(SteeredScene steered, size_t timeline_bytes)
    : steered_(std::move(steered)),
      pins_(model()),
      hand_(default_stiffness(model())),
      history_(simulation(), timeline_bytes) {
  history_.add(snapshot());
}

Snapshot Side::snapshot() const {
  Snapshot now = history_.snapshot_of(simulation());
  now.grab = hand_.resting(time());
  now.tool = tool().resting(time());
  now.pins = pins_.now();
  return now;
}

void Side::rest() {
  steered_.mouse->set(hand_.resting(time()));
  steered_.tool->set(tool().resting(time()));
}

void Side::act() {
  const Interval step{time(), history_.end_of_next_step(simulation())};
  acted_ = {hand_.acting(step), tool().acting(step)};
  steered_.mouse->set(acted_.grab);
  steered_.tool->set(acted_.tool);
}

void Side::record_edit() {
  iteration_ = -1;
  history_.replace_last(snapshot());
}

// ---------------------------------------------------------------- steps

Progress Side::complete(const StepReport& report) {
  iteration_ = -1;
  hand_.finish_step();
  steered_.tool->finish_step();
  rest();
  const double by_hand = report.target_work[steered_.mouse_load];
  const double by_tool = steered_.tool_load == steered_.mouse_load ? 0 : report.target_work[steered_.tool_load];
  Snapshot now = snapshot();
  now.acted = acted_;
  history_.add(std::move(now), {.report = report,
                                .iterations = iterations_.take(),
                                .mouse_work = by_hand + std::exchange(hand_work_, 0),
                                .tool_work = by_tool + std::exchange(tool_work_, 0),
                                .pin_work = report.pin_work - by_hand - by_tool,
                                .load_work = report.load_work - by_hand - by_tool,
                                .pins = pin_names(model()),
                                .why = explain(simulation(), report)});
  is_blown_up_ = report.status == Status::undefined && !simulation().integrator().is_implicit;
  return is_blown_up_ ? Progress::blown_up : Progress::stepped;
}

StepReport Side::acted_step(const IterationObserver& observe, const StopToken& stop) {
  iterations_.begin();
  act();
  const StepReport report = simulated().step(observe, stop);
  if (report.status == Status::interrupted) rest();
  return report;
}

Progress Side::step(const StopToken& stop) {
  const StepReport report = acted_step([&](const LiveIteration& live) { iterations_.add(live); }, stop);
  return report.status == Status::interrupted ? Progress::interrupted : complete(report);
}

// Takes the step from its start to one more iteration, and drops it when the next iteration begins. Later calls repeat
// the same iterations, so the result does not depend on the number of calls.
Progress Side::iterate(const StopToken& stop) {
  const int shown = iteration_ + 1;
  int count = 0;
  std::vector<double> iterate;
  const auto observe = [&](const LiveIteration& live) {
    if (count == shown) iterate.assign(live.x_next.begin(), live.x_next.end());
    if (count++ <= shown) iterations_.add(live);
  };
  const StepReport report = acted_step(observe, StopToken([&] { return count > shown + 1 || stop.stopped(); }));
  if (report.status != Status::interrupted) return complete(report);
  if (count <= shown + 1) return Progress::interrupted;
  iterate_ = std::move(iterate);
  iteration_ = shown;
  return Progress::iterated;
}

void Side::rewind(int step) {
  iteration_ = -1;
  is_blown_up_ = false;
  hand_work_ = tool_work_ = 0;
  const Snapshot snapshot = history_.return_to(step);
  history_.restore(snapshot, simulated());
  if (pins_.now() != snapshot.pins) {
    history_.change_settings();
    pins_.set(snapshot.pins);
    simulated().set_pins(*snapshot.pins);
  }
  hand_.return_to(snapshot.grab);
  steered_.tool->return_to(snapshot.tool);
  try {
    rest();
  } catch (const InvalidInput&) {  // the new shape has no surface at this place
    steered_.tool->return_to(nullptr);
    rest();
  }
  if (hand_.is_grabbing()) edit([](Tools& tools, Positions) { tools.hand.release(); });
}

StepReport Side::repeat(int step, const IterationObserver& observe, const StopToken& stop,
                        const std::function<void()>& finish) {
  const Simulation::Snapshot now = simulation().snapshot();
  const Snapshot* after = history_.restore_start_of(step, simulated());
  if (after) {
    steered_.mouse->set(after->acted.grab);
    steered_.tool->set(after->acted.tool);
  } else {
    act();
  }
  const StepReport report = simulated().step(observe, stop);
  if (finish && report.status != Status::interrupted) finish();
  simulated().restore(now);
  rest();
  return report;
}

void Side::estimate_mesh_error(const StopToken& stop) {
  const StepRow* last = history_.rows().last();
  if (!last) throw InvalidInput("the error of the mesh is estimated after a step; take one first");
  if (!is_success(last->report.status))
    throw InvalidInput("the last step did not converge; the error of the mesh is estimated after a converged step");
  StepReport estimate;
  repeat(steps_taken(), {}, stop, [&] { add_mesh_error(simulation(), stop, estimate); });
  if (!stop.stopped()) history_.set_mesh_error(std::move(estimate));
}

std::span<const double> Side::mesh_error() const {
  const StepRow* last = history_.rows().last();
  if (!last || iteration_ >= 0) return {};
  return last->report.mesh_density;
}

// ---------------------------------------------------------------- edits

void Side::apply(SceneChange change) {
  iteration_ = -1;
  is_blown_up_ = false;
  history_.change_settings();
  if (change.solver) {
    simulated().set_solver(*change.solver);
    steered_.scene.resolved = to_toml(change.document);
    steered_.document = std::move(change.document);
    steered_.overrides = std::move(change.overrides);
    return;
  }
  const Snapshot now = snapshot();
  steered_ = *std::move(change.reloaded);
  simulated().set_pins(*pins_.now());  // the reloaded scene may select other vertices
  history_.restore(now, simulated());
  rest();
  record_edit();
}

void Side::edit(const std::function<void(Tools&, Positions)>& change) {
  const Positions x = simulation().state().q;
  const double hand_energy = hand_.energy(x), tool_energy = tool().energy(x);
  Tools tools{hand_, *steered_.tool};
  change(tools, x);
  rest();
  hand_work_ += hand_.energy(x) - hand_energy;
  tool_work_ += tool().energy(x) - tool_energy;
  record_edit();
}

void Side::aim(const std::function<void(Tools&)>& change) {
  iteration_ = -1;
  Tools tools{hand_, *steered_.tool};
  change(tools);
}

void Side::set_stiffness(double stiffness) {
  if (!hand_.is_grabbing()) return hand_.set_stiffness(stiffness);
  edit([&](Tools& tools, Positions) { tools.hand.set_stiffness(stiffness); });
}

void Side::pin(const std::vector<int>& vertices, bool pinned) {
  std::vector<Pin> pins = pins_.painted(vertices, pinned, simulation().state().q);
  simulated().set_pins(pins);
  pins_.set(std::make_shared<const std::vector<Pin>>(std::move(pins)));
  history_.change_settings();
  record_edit();
}

}  // namespace aspic::viewer
