#include "viewer/timeline.h"

#include <algorithm>

#include "base/check.h"

namespace aspic::viewer {
namespace {

constexpr size_t kPinBytes = sizeof(Pin) + 64;  // size of a pin set by hand

}  // namespace

size_t Snapshot::bytes() const {
  size_t numbers = state.q.size() + state.qdot.size();
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

}  // namespace aspic::viewer
