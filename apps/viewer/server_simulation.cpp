#include "viewer/server_simulation.h"

#include <algorithm>
#include <utility>

namespace aspic::viewer {
namespace {

constexpr size_t kInboxRequests = 1000, kInboxBytes = size_t{64} << 20;
constexpr std::chrono::milliseconds kSlow(300);  // urgent requests interrupt longer work

}  // namespace

SimulationThread::SimulationThread(Session& session, Audience& audience)
    : session_(session), audience_(audience), paced_(session) {
  thread_ = std::thread([this] {
    try {
      run();
    } catch (...) {
      const std::lock_guard lock(mutex_);
      failure_ = std::current_exception();
    }
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
  if (busy_since_ && most >= interruptible_by_ && Clock::now() - *busy_since_ > kSlow) session_.interrupt();
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
    play();
    show_pictures();
  }
}

// Waits until a request arrives, the next step is due, or a requested picture is due.
void SimulationThread::wait() {
  std::unique_lock lock(mutex_);
  const auto woken = [&] { return woken_; };
  if (const auto due = paced_.next(pictures_wanted_)) {
    changed_.wait_until(lock, *due, woken);
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
    interruptible_by_ = for_what;
  }
  auto result = work();
  const std::lock_guard lock(mutex_);
  busy_since_.reset();
  return result;
}

void SimulationThread::carry_out(const Request& request) {
  if (request.text.empty()) return audience_.greet(request.page, session_.greeting(request.role));
  const Urgency interruptible_by = request.is_question ? Urgency::before_questions : Urgency::before_steps;
  Answer answer = interruptibly(interruptible_by, [&] { return session_.handle(request.text, request.role); });
  if (!answer.to_all.empty()) audience_.broadcast(std::move(answer.to_all));
  if (!answer.to_sender.empty() && request.page != kNoPage) audience_.reply(request.page, std::move(answer.to_sender));
}

void SimulationThread::play() {
  if (!paced_.is_step_due()) return;
  audience_.broadcast(
      interruptibly(Urgency::before_steps, [&] { return paced_.advance([this] { return is_woken(); }); }));
}

void SimulationThread::show_pictures() {
  if (!paced_.are_pictures_due()) return;
  {
    const std::lock_guard lock(mutex_);
    if (!pictures_wanted_) return;
    pictures_wanted_ = false;
  }
  Messages pictures = paced_.pictures();
  audience_.show(std::move(pictures), paced_.shown_version());
}

}  // namespace aspic::viewer
