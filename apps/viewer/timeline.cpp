#include "viewer/timeline.h"

#include <algorithm>

#include "base/check.h"

namespace aspic::viewer {
namespace {

constexpr size_t kPinBytes = sizeof(Pin) + 64;  // of a vertex pinned by hand

}  // namespace

size_t Moment::bytes() const {
  size_t numbers = state.q.size() + state.qdot.size();
  if (previous) numbers += previous->q.size() + previous->qdot.size();
  size_t size = sizeof(Moment) + sizeof(double) * numbers;
  if (pins) size += kPinBytes * pins->size();  // more than there are where several moments share them
  return size;
}

void Timeline::add(Moment moment) {
  ASPIC_CHECK(moments_.empty() || moments_.back().step < moment.step);
  bytes_ += moment.bytes();
  moments_.push_back(std::move(moment));
  while (bytes_ > most_bytes_ && moments_.size() > 3) thin_out();
}

void Timeline::thin_out() {
  const size_t old = std::max<size_t>(moments_.size() / 2, 2);
  size_t kept = 0;
  bytes_ = 0;
  for (size_t i = 0; i < moments_.size(); ++i) {
    if (i < old && i % 2 == 1) continue;
    bytes_ += moments_[i].bytes();
    if (kept != i) moments_[kept] = std::move(moments_[i]);
    ++kept;
  }
  moments_.resize(kept);
}

const Moment& Timeline::nearest(int step) const {
  const auto later = std::upper_bound(moments_.begin(), moments_.end(), step,
                                      [](int s, const Moment& moment) { return s < moment.step; });
  return later == moments_.begin() ? moments_.front() : *(later - 1);
}

const Moment* Timeline::find(int step) const {
  if (moments_.empty()) return nullptr;
  const Moment& moment = nearest(step);
  return moment.step == step ? &moment : nullptr;
}

const Moment* Timeline::at_time(double time, double tolerance) const {
  for (auto moment = moments_.rbegin(); moment != moments_.rend(); ++moment) {
    if (moment->state.time < time - tolerance) return nullptr;
    if (moment->state.time <= time + tolerance) return &*moment;
  }
  return nullptr;
}

void Timeline::drop_after(int step) {
  while (!moments_.empty() && moments_.back().step > step) {
    bytes_ -= moments_.back().bytes();
    moments_.pop_back();
  }
}

}  // namespace aspic::viewer
