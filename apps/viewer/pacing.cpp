#include "viewer/pacing.h"

#include <algorithm>

namespace aspic::viewer {
namespace {

using Seconds = std::chrono::duration<double>;

constexpr Seconds kForgotten(0.1);    // longer delays are not made up for
constexpr Seconds kLongestWait(1e4);  // for speeds near zero
constexpr Seconds kRateWindow(0.5);
constexpr std::chrono::microseconds kBetweenPictures(16'600);

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

bool PacedSession::is_step_due() {
  const bool starts = !was_playing_;
  was_playing_ = session_.is_playing();
  if (!was_playing_) return false;
  const Clock::time_point now = Clock::now();
  if (starts) {
    pacing_.pause();
    rate_.start(session_.time(), now);
  }
  next_step_ = pacing_.due(session_.time(), session_.speed(), now);
  return next_step_ <= now;
}

Messages PacedSession::advance(const std::function<bool()>& is_awaited) {
  const auto is_next_due = [&, together = Clock::now() + kBetweenPictures] {
    const Clock::time_point then = Clock::now();
    return then < together && !is_awaited() && pacing_.due(session_.time(), session_.speed(), then) <= then;
  };
  Messages messages = session_.advance(is_next_due);
  if (rate_.update(session_.time(), Clock::now())) session_.note_rate(rate_.value());
  next_step_ = pacing_.due(session_.time(), session_.speed(), Clock::now());
  return messages;
}

bool PacedSession::are_pictures_due() const {
  return shown_ != session_.picture_version() && Clock::now() >= next_picture_;
}

Messages PacedSession::pictures() {
  shown_ = session_.picture_version();
  next_picture_ = Clock::now() + kBetweenPictures;
  return session_.pictures();
}

std::optional<Pacing::Clock::time_point> PacedSession::next(bool wants_pictures) const {
  const bool shows = wants_pictures && shown_ != session_.picture_version();
  if (session_.is_playing()) return shows ? std::min(next_step_, next_picture_) : next_step_;
  if (shows) return next_picture_;
  return std::nullopt;
}

}  // namespace aspic::viewer
