#include "viewer/history.h"

#include <fmt/format.h>
#include <algorithm>

#include "base/check.h"
#include "base/error.h"

namespace aspic::viewer {
namespace {

constexpr size_t kPinBytes = sizeof(Pin) + 64;  // size of a pin set by hand

}  // namespace

size_t Snapshot::bytes() const {
  size_t numbers = state.q.size() + state.qdot.size() + state.internal.size();
  if (previous) numbers += previous->q.size() + previous->qdot.size();
  size_t size = sizeof(Snapshot) + sizeof(double) * numbers;
  if (pins) size += kPinBytes * pins->size();  // counts shared pins several times
  return size;
}

void Timeline::add(Snapshot snapshot) {
  ASPIC_CHECK(snapshots_.empty() || snapshots_.back().step < snapshot.step);
  bytes_ += snapshot.bytes();
  snapshots_.push_back(std::move(snapshot));
  while (bytes_ > most_bytes_ && snapshots_.size() > 3) thin_out();
}

void Timeline::thin_out() {
  const size_t old = std::max<size_t>(snapshots_.size() / 2, 2);
  size_t kept = 0;
  bytes_ = 0;
  for (size_t i = 0; i < snapshots_.size(); ++i) {
    if (i < old && i % 2 == 1) continue;
    bytes_ += snapshots_[i].bytes();
    if (kept != i) snapshots_[kept] = std::move(snapshots_[i]);
    ++kept;
  }
  snapshots_.resize(kept);
}

const Snapshot& Timeline::nearest(int step) const {
  const auto later = std::upper_bound(snapshots_.begin(), snapshots_.end(), step,
                                      [](int s, const Snapshot& snapshot) { return s < snapshot.step; });
  return later == snapshots_.begin() ? snapshots_.front() : *(later - 1);
}

const Snapshot* Timeline::find(int step) const {
  if (snapshots_.empty()) return nullptr;
  const Snapshot& snapshot = nearest(step);
  return snapshot.step == step ? &snapshot : nullptr;
}

const Snapshot* Timeline::at_time(double time, double tolerance) const {
  for (auto snapshot = snapshots_.rbegin(); snapshot != snapshots_.rend(); ++snapshot) {
    if (snapshot->state.time < time - tolerance) return nullptr;
    if (snapshot->state.time <= time + tolerance) return &*snapshot;
  }
  return nullptr;
}

void Timeline::drop_after(int step) {
  while (!snapshots_.empty() && snapshots_.back().step > step) {
    bytes_ -= snapshots_.back().bytes();
    snapshots_.pop_back();
  }
}

History::History(const Simulation& simulation, size_t timeline_bytes)
    : start_(std::make_shared<const State>(simulation.snapshot().start)),
      start_time_(start_->time),
      timeline_(timeline_bytes) {}

double History::end_of_next_step(const Simulation& simulation) const {
  return start_time_ + (simulation.steps_taken() + 1) * simulation.options().h;
}

Snapshot History::snapshot_of(const Simulation& simulation) const {
  Simulation::Snapshot now = simulation.snapshot();
  const double obstacle_time = simulation.obstacle_time();
  return {.step = now.steps_taken,
          .state = std::move(now.state),
          .previous = std::move(now.previous),
          .level = now.level,
          .obstacle_time = obstacle_time,
          .outside_work = now.outside_work,
          .start_time = start_time_,
          .h = simulation.options().h,
          .integrator = simulation.options().integrator,
          .settings = settings_};
}

void History::add(Snapshot snapshot) { timeline_.add(std::move(snapshot)); }

void History::add(Snapshot snapshot, StepRow row) {
  if (snapshot.acted.grab.stiffness > 0) pulls_.push_back({snapshot.step, snapshot.acted.grab});
  rows_.add(std::move(row));
  add(std::move(snapshot));
}

void History::replace_last(Snapshot snapshot) {
  const Snapshot& last = timeline_.last();
  snapshot.acted = last.acted;
  snapshot.settings = last.settings;
  timeline_.drop_after(snapshot.step - 1);
  add(std::move(snapshot));
}

Snapshot History::return_to(int step) {
  Snapshot snapshot = timeline_.nearest(step);
  timeline_.drop_after(snapshot.step);
  rows_.drop_after(snapshot.step);
  while (!pulls_.empty() && pulls_.back().step > snapshot.step) pulls_.pop_back();
  return snapshot;
}

// A simulation counts steps from its start. After a change of the step length it continues from its state, and the
// start moves to the time from which the same number of steps of the new length reaches that state.
Simulation::Snapshot History::simulation_state(const Snapshot& snapshot, const SimulationOptions& options) const {
  const bool is_same_step = options.h == snapshot.h;
  State start = *start_;
  start.time = is_same_step ? snapshot.start_time : snapshot.state.time - snapshot.step * options.h;
  return {.state = snapshot.state,
          .start = std::move(start),
          .steps_taken = snapshot.step,
          .level = snapshot.level,
          .previous = is_same_step && options.integrator == snapshot.integrator ? snapshot.previous : std::nullopt,
          .obstacle_time = snapshot.obstacle_time,
          .outside_work = snapshot.outside_work};
}

void History::restore(const Snapshot& snapshot, Simulation& simulation) {
  const Simulation::Snapshot state = simulation_state(snapshot, simulation.options());
  simulation.restore(state);
  start_time_ = state.start.time;
}

const Snapshot* History::restore_start_of(int step, Simulation& simulation) const {
  const int taken = simulation.steps_taken();
  const bool is_next = step == taken + 1;
  const Snapshot* before = timeline_.find(step - 1);
  const Snapshot* after = is_next ? nullptr : timeline_.find(step);
  if (!before || (!is_next && !after))
    throw InvalidInput(fmt::format("step {} cannot be repeated: {}", step,
                                   step < 1 || step > taken + 1
                                       ? fmt::format("there are steps 1 to {}", taken + 1)
                                       : "its initial state is no longer stored; choose a later step"));
  if (after && after->settings != settings_)
    throw InvalidInput(
        fmt::format("step {} was taken with other settings or pins than now, so it cannot be repeated", step));
  simulation.restore(simulation_state(*before, simulation.options()));
  return after;
}

}  // namespace aspic::viewer
