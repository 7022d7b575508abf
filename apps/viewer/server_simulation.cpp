#include "viewer/server_simulation.h"

#include <algorithm>

namespace aspic::viewer {
namespace {

using Seconds = std::chrono::duration<double>;

constexpr Seconds kForgotten(0.1);    // longer delays are not made up for
constexpr Seconds kLongestWait(1e4);  // for speeds near zero
constexpr Seconds kRateWindow(0.5);

constexpr size_t kInboxRequests = 1000, kInboxBytes = size_t{64} << 20;
constexpr std::chrono::milliseconds kSlow(300);  // urgent requests interrupt longer work
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

SimulationThread::SimulationThread(Session& session, Audience& audience) : session_(session), audience_(audience) {
  thread_ = std::thread([this] {
    try {
      run();
    } catch (...) {
      const std::lock_guard lock(mutex_);
      failure_ = std::current_exception();
    }
    fit_.reset();
    const std::lock_guard lock(mutex_);
    has_ended_ = true;
    ended_.notify_all();
  });
}

SimulationThread::~SimulationThread() {
  stop(std::chrono::milliseconds(0));
  thread_.join();
}

bool SimulationThread::add(Request request) {
  const std::lock_guard lock(mutex_);
  const size_t size = request.text.size();
  if (!inbox_.empty()) {
    Request& last = inbox_.back();
    if (last.aim != Aim::none && last.aim == request.aim && last.page == request.page && last.role == request.role) {
      inbox_bytes_ += size - last.text.size();
      last = std::move(request);
      return true;
    }
  }
  if (inbox_.size() >= kInboxRequests || inbox_bytes_ + size > kInboxBytes) return false;
  inbox_bytes_ += size;
  inbox_.push_back(std::move(request));
  woken_ = true;
  changed_.notify_one();
  return true;
}

void SimulationThread::want_pictures() {
  const std::lock_guard lock(mutex_);
  pictures_wanted_ = woken_ = true;
  changed_.notify_one();
}

bool SimulationThread::interrupt_if_slow() {
  const std::lock_guard lock(mutex_);
  Urgency most = Urgency::none;
  for (const Request& request : inbox_) most = std::max(most, request.urgency);
  if (most == Urgency::none) return false;
  if (busy_since_ && most >= gives_way_to_ && Clock::now() - *busy_since_ > kSlow) session_.interrupt();
  return true;
}

bool SimulationThread::stop(std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  stopping_ = woken_ = true;
  if (busy_since_) session_.interrupt();
  changed_.notify_one();
  return ended_.wait_for(lock, patience, [&] { return has_ended_; });
}

void SimulationThread::check() const {
  const std::lock_guard lock(mutex_);
  if (failure_) std::rethrow_exception(failure_);
}

void SimulationThread::run() {
  for (;;) {
    wait();
    while (std::optional<Request> request = next()) carry_out(*request);
    {
      const std::lock_guard lock(mutex_);
      if (stopping_) return;
    }
    serve_fit();
    play();
    show_pictures();
  }
}

// Waits until a request arrives, the next step is due, or a requested picture is due.
void SimulationThread::wait() {
  const bool playing = session_.is_playing();
  const bool has_news = shown_ != session_.picture_version();
  std::unique_lock lock(mutex_);
  const auto woken = [&] { return woken_; };
  const bool shows = pictures_wanted_ && has_news;
  if (playing && shows) {
    changed_.wait_until(lock, std::min(next_step_, next_picture_), woken);
  } else if (playing || shows) {
    changed_.wait_until(lock, playing ? next_step_ : next_picture_, woken);
  } else {
    changed_.wait(lock, woken);
  }
  woken_ = false;
}

std::optional<Request> SimulationThread::next() {
  const std::lock_guard lock(mutex_);
  if (stopping_ || inbox_.empty()) return std::nullopt;
  Request request = std::move(inbox_.front());
  inbox_.pop_front();
  inbox_bytes_ -= request.text.size();
  return request;
}

bool SimulationThread::is_woken() const {
  const std::lock_guard lock(mutex_);
  return woken_;
}

// Runs work that requests of at least this urgency may interrupt. Later work is not affected.
template <class Work>
auto SimulationThread::interruptibly(Urgency for_what, Work work) {
  {
    const std::lock_guard lock(mutex_);
    busy_since_ = Clock::now();
    gives_way_to_ = for_what;
  }
  auto result = work();
  const std::lock_guard lock(mutex_);
  busy_since_.reset();
  return result;
}

void SimulationThread::carry_out(const Request& request) {
  if (request.text.empty()) return audience_.greet(request.page, session_.greeting(request.role));
  const Urgency gives_way_to = request.is_question ? Urgency::before_questions : Urgency::before_steps;
  Answer answer = interruptibly(gives_way_to, [&] { return session_.handle(request.text, request.role); });
  if (!answer.to_all.empty()) audience_.broadcast(std::move(answer.to_all));
  if (!answer.to_sender.empty() && request.page != kNoPage) audience_.reply(request.page, std::move(answer.to_sender));
}

// The fit runs in parallel with the simulation. Its news is handled between two steps.
void SimulationThread::serve_fit() {
  if (std::optional<FitTask> task = session_.take_fit())
    fit_ = std::make_unique<FitJob>(*std::move(task), [this] {
      const std::lock_guard lock(mutex_);
      woken_ = true;
      changed_.notify_one();
    });
  if (!fit_) return;
  if (!session_.wants_fit()) fit_->stop();
  const bool has_ended = fit_->has_ended();
  if (const std::optional<FitNews> news = fit_->news()) audience_.broadcast(session_.note_fit(*news));
  if (has_ended) fit_.reset();
}

void SimulationThread::play() {
  const bool starts = !was_playing_;
  was_playing_ = session_.is_playing();
  if (!was_playing_) return;
  const Clock::time_point now = Clock::now();
  if (starts) {
    pacing_.pause();
    rate_.start(session_.time(), now);
  }
  next_step_ = pacing_.due(session_.time(), session_.speed(), now);
  if (next_step_ > now) return;
  // Short steps are reported together.
  const auto is_next_due = [&, together = now + kBetweenPictures] {
    const Clock::time_point then = Clock::now();
    return then < together && !is_woken() && pacing_.due(session_.time(), session_.speed(), then) <= then;
  };
  audience_.broadcast(interruptibly(Urgency::before_steps, [&] { return session_.advance(is_next_due); }));
  if (rate_.update(session_.time(), Clock::now())) session_.note_rate(rate_.value());
  next_step_ = pacing_.due(session_.time(), session_.speed(), Clock::now());
}

void SimulationThread::show_pictures() {
  const long version = session_.picture_version();
  const Clock::time_point now = Clock::now();
  if (shown_ == version || now < next_picture_) return;
  {
    const std::lock_guard lock(mutex_);
    if (!pictures_wanted_) return;
    pictures_wanted_ = false;
  }
  shown_ = version;
  next_picture_ = now + kBetweenPictures;
  audience_.show(session_.pictures(), version);
}

}  // namespace aspic::viewer
