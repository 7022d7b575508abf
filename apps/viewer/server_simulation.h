// The thread that owns the session. It carries out the requests of the pages in order of arrival and takes each step
// when it is due. Other threads add requests to its inbox.
#pragma once
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "viewer/pacing.h"

namespace aspic::viewer {

using PageId = long;                  // number of a connected page
inline constexpr PageId kNoPage = 0;  // the server itself

// Receives the messages of the session. Called on the simulation's thread.
class Audience {
 public:
  virtual ~Audience() = default;
  virtual void greet(PageId page, Messages messages) = 0;
  virtual void reply(PageId page, Messages messages) = 0;
  virtual void broadcast(Messages messages) = 0;
  virtual void show(Messages pictures, long version) = 0;
};

// The slow work that a request interrupts.
enum class Urgency { none, before_questions, before_steps };

enum class Aim { none, mouse, tool };  // what a request moves

struct Request {
  PageId page = kNoPage;
  Role role = Role::watches;
  std::string text;  // empty: greets a new page
  Urgency urgency = Urgency::none;
  bool is_question = false;
  Aim aim = Aim::none;  // a directly following request with the same aim replaces this one
};

class SimulationThread {
 public:
  SimulationThread(Session& session, Audience& audience);
  ~SimulationThread();  // waits for the end of the current step

  bool add(Request request);  // false: the inbox is full
  void want_pictures();       // shows the next pictures that differ from the last ones

  // Interrupts slow work if a more urgent request waits. Returns false if none waits.
  bool interrupt_if_slow();

  bool stop(std::chrono::milliseconds patience);  // false: the current step has not ended
  void check() const;                             // rethrows the exception that ended the thread

 private:
  using Clock = Pacing::Clock;

  void run();
  void wait();
  bool is_woken() const;
  std::optional<Request> next();
  void carry_out(const Request& request);
  void play();
  void show_pictures();
  template <class Work>
  auto interruptibly(Urgency for_what, Work work);

  Session& session_;
  Audience& audience_;

  // Used by the thread alone.
  PacedSession paced_;

  mutable std::mutex mutex_;  // guards everything below
  std::condition_variable changed_, ended_;
  std::deque<Request> inbox_;
  size_t inbox_bytes_ = 0;
  bool woken_ = false, stopping_ = false, has_ended_ = false, pictures_wanted_ = false;
  std::optional<Clock::time_point> busy_since_;       // start of the current interruptible work
  Urgency interruptible_by_ = Urgency::before_steps;  // minimum urgency that interrupts this work
  std::exception_ptr failure_;

  std::thread thread_;
};

}  // namespace aspic::viewer
