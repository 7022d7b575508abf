#include "viewer/server_pacing.h"

#include <algorithm>

namespace aspic::viewer {
namespace {

using Seconds = std::chrono::duration<double>;

constexpr Seconds kForgotten(0.1);    // longer delays are not made up for
constexpr Seconds kLongestWait(1e4);  // for speeds near zero
constexpr Seconds kRateWindow(0.5);

}  // namespace

Pacing::Clock::time_point Pacing::due(double time, double speed, Clock::time_point now) {
  const auto since_start = [&] { return Seconds(std::min((time - start_time_) / speed, kLongestWait.count())); };
  const bool continues = speed == speed_ && time >= last_time_;
  last_time_ = time;
  if (!continues || now - (start_ + since_start()) > kForgotten) {
    start_ = now;
    start_time_ = time;
    speed_ = speed;
  }
  return start_ + std::chrono::duration_cast<Clock::duration>(since_start());
}

void Rate::start(double time, Clock::time_point now) {
  start_ = now;
  start_time_ = time;
}

bool Rate::update(double time, Clock::time_point now) {
  const Seconds passed = now - start_;
  if (passed < kRateWindow) return false;
  value_ = std::max(0.0, (time - start_time_) / passed.count());
  start(time, now);
  return true;
}

}  // namespace aspic::viewer
